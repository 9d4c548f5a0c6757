// SPDX-License-Identifier: BSD-3-Clause
// Joint occlusion of many directions is distinguished from flicker.
#include "plugins/diagnose/scene/visibility.hpp"

#include <gmock/gmock.h>

#include <random>

namespace crisp {
namespace {

using namespace crisp::diagnose;

TEST(ChangingDirections, DistinguishJointOcclusionFromIndependentOnes) {
  std::mt19937_64 random(1);
  constexpr std::size_t kTimes = 12, kDirections = 30;
  const auto directions = [&](bool at_once) {
    ChangingDirections all;
    for (std::size_t k = 0; k < kDirections; ++k) {
      std::vector<Visibility> views(kTimes, Visibility::kSurface);
      for (std::size_t h = 0; h < 3; ++h) views[at_once ? 4 + h : random() % kTimes] = Visibility::kHidden;
      all.views.push_back(views);
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
