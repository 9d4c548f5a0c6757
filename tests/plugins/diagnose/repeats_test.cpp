// SPDX-License-Identifier: BSD-3-Clause
// What changes at once over some directions is told from what flickers.
#include "plugins/diagnose/repeats.hpp"

#include <gmock/gmock.h>

#include <random>

namespace crisp {
namespace {

TEST(Directions, HiddenAtTheSameTimeAreToldFromThoseAtAnyTime) {
  std::mt19937_64 random(1);
  constexpr std::size_t kTimes = 12, kDirections = 30;
  const auto directions = [&](bool at_once) {
    ChangingDirections all;
    for (std::size_t k = 0; k < kDirections; ++k) {
      std::vector<Glimpse> looks(kTimes, Glimpse::kSurface);
      for (std::size_t h = 0; h < 3; ++h) looks[at_once ? 4 + h : random() % kTimes] = Glimpse::kHidden;
      all.looks.push_back(looks);
      if (k > 0) all.neighbours.emplace_back(k - 1, k);
    }
    return all;
  };
  EXPECT_LT(p_value(directions(true), 1), 0.002);
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) named += moving(directions(false), seed) ? 1 : 0;
  EXPECT_LE(named, 1);
}

}  // namespace
}  // namespace crisp
