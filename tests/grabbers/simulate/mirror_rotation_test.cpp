// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/mirror_rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::simulate;

std::vector<Revolution> turns(const MirrorSettings& settings, std::uint64_t seed, int n) {
  Mirror mirror(settings, seed, "laser1");
  std::vector<Revolution> result;
  for (int i = 0; i < n; ++i) result.push_back(mirror.next());
  return result;
}

TEST(Mirror, TurnsSlowerThanNominalAndWandersWithinItsBounds) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto all = turns({}, seed, 3000);
    const auto [shortest, longest] =
        std::minmax_element(all.begin(), all.end(), [](auto& a, auto& b) { return a.period < b.period; });
    EXPECT_GE(shortest->period, 0.020 * (1 - 0.002));
    EXPECT_LE(longest->period, 0.020 * (1 + 0.006 + 0.002));
    EXPECT_GT(longest->period - shortest->period, 0.020 * 0.002) << "wanders both ways";
  }
}

TEST(Mirror, HasThePeriodThatWasRequested) {
  // 0.57 % of 20 ms
  Mirror mirror({.wander = 0}, 1, "laser1", 114e-6);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(mirror.next().period, 0.020114, 1e-12);
}

TEST(Mirror, WandersAsMuchAsWasRequested) {
  constexpr double kRms = 1.1e-3;
  const MirrorSettings settings{.slowest = 0, .wander = Mirror::wander_of_rms(kRms)};
  Mirror mirror(settings, 1, "laser1");
  constexpr int kTurns = 500'000;  // 10 000 s: a thousand waves and more
  double squares = 0;
  for (int i = 0; i < kTurns; ++i) squares += std::pow(mirror.next().period * settings.frequency - 1, 2);
  EXPECT_NEAR(std::sqrt(squares / kTurns), kRms, 0.01 * kRms);
}

TEST(Mirror, BeginsEachTurnWhereTheLastOneEnded) {
  const auto all = turns({.jitter = 1e-3}, 1, 1000);
  EXPECT_GE(all.front().begin, 0);
  EXPECT_LT(all.front().begin, 0.020);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_EQ(all[i].number, i);
    EXPECT_DOUBLE_EQ(all[i].begin, all[i - 1].begin + all[i - 1].period);
  }
}

TEST(Mirror, HasTheJitterThatWasRequested) {
  const auto all = turns({.slowest = 0, .wander = 0, .jitter = 1e-3}, 1, 20000);
  double sum = 0;
  for (const auto& turn : all) sum += std::pow(turn.period - 0.020, 2);
  EXPECT_NEAR(std::sqrt(sum / 20000) / 0.020, 1e-3, 4e-3 / std::sqrt(2 * 20000));
}

TEST(Mirror, RefusesPeriodsThatNoMirrorHas) {
  EXPECT_THROW(Mirror({.frequency = 0}, 1, "laser1"), Error);
  EXPECT_THROW(Mirror({.wander = 1}, 1, "laser1"), Error);
}

}  // namespace
}  // namespace crisp
