// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/agreement.hpp"

#include <gmock/gmock.h>

#include "tests/pipeline/estimate/viewed_surfels.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Agreement agreement_of(const test::ViewedSurfels& wall, std::size_t lasers) {
  return agreement(wall.surfels, wall.view(), lasers, 0.01);
}

TEST(Agreement, CountsBeamsThatOthersMeetAtTheSamePlace) {
  test::ViewedSurfels wall;
  wall.add({{.view = 0, .height = 0, .beams = 100}, {.view = 3, .height = 0.02, .beams = 60}});  // within 3 σ
  wall.add({{.view = 0, .height = 0, .beams = 100}, {.view = 2, .height = 0.05, .beams = 20}});  // apart
  wall.add({{.view = 4, .height = 0, .beams = 50}});                                             // alone
  wall.add({{.view = 0, .height = 0, .beams = 1000}, {.view = 2, .height = 0, .beams = 4}});     // by chance
  const Agreement found = agreement_of(wall, 4);
  EXPECT_FALSE(found.by_halves);
  EXPECT_THAT(found.shares, ElementsAre(100.0 / 1200, (60.0 + 4) / 84, 0, -1));
  const auto said = disagreements(found, {"one", "two", "three", "four"});
  ASSERT_EQ(said.size(), 2U);
  EXPECT_THAT(said[0], HasSubstr("only 8 % of what one sees of flat surfaces is where others see it"));
  EXPECT_THAT(said[1], HasSubstr("only 0 % of what three sees"));
}

TEST(Agreement, ComparesTheHalvesOfALaserThatIsAlone) {
  test::ViewedSurfels wall;
  wall.add({{.view = 2, .height = 0, .beams = 100}, {.view = 3, .height = 0.1, .beams = 100}});
  wall.add({{.view = 2, .height = 0, .beams = 200}, {.view = 3, .height = 0, .beams = 50}});
  const Agreement found = agreement_of(wall, 2);
  EXPECT_TRUE(found.by_halves);
  EXPECT_THAT(found.shares, ElementsAre(-1, -1, 200.0 / 300, 50.0 / 150));
  const auto said = disagreements(found, {"one", "two"});
  ASSERT_EQ(said.size(), 1U);
  EXPECT_THAT(said[0], HasSubstr("the back of two"));
}

}  // namespace
}  // namespace crisp
