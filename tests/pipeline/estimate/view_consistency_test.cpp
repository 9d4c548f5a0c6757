// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/view_consistency.hpp"

#include <gmock/gmock.h>

#include "tests/pipeline/estimate/support.hpp"
#include "tests/pipeline/estimate/viewed_surfels.hpp"

namespace crisp {
namespace {

using testing::AllOf;
using testing::Field;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::vector<ViewConsistency> consistency_of(const test::ViewedSurfels& wall,
                                            const std::vector<std::string>& views) {
  return view_consistency(wall.surfels, wall.view(), {.views = views, .of_beam = wall.views, .advice = {}},
                          0.01);
}

auto pair_of(const std::string& view, const std::string& other, double beams, double agreed) {
  return AllOf(Field(&ViewConsistency::view, view), Field(&ViewConsistency::other, other),
               Field(&ViewConsistency::beams, beams),
               Field(&ViewConsistency::share, testing::DoubleEq(agreed / beams)));
}

TEST(ViewConsistency, CountsBeamsThatTheOtherViewMeetsAtTheSamePlace) {
  test::ViewedSurfels wall;
  wall.add({{.view = 0, .height = 0, .beams = 100}, {.view = 1, .height = 0.02, .beams = 60}});  // within 3 σ
  wall.add({{.view = 0, .height = 0, .beams = 100}, {.view = 1, .height = 0.05, .beams = 20}});  // apart
  wall.add({{.view = 0, .height = 0, .beams = 1000}, {.view = 1, .height = 0, .beams = 4}});     // by chance
  EXPECT_THAT(consistency_of(wall, {"a", "b"}),
              UnorderedElementsAre(pair_of("a", "b", 1200, 100), pair_of("b", "a", 84, 64)));
}

TEST(ViewConsistency, EachPairOfThreeIsComparedSoThatTwoWhichAgreeHideNoThird) {
  test::ViewedSurfels wall;
  wall.add({{.view = 0, .height = 0, .beams = 100}, {.view = 1, .height = 0, .beams = 100}});
  wall.add({{.view = 2, .height = 0.04, .beams = 100}});
  EXPECT_THAT(consistency_of(wall, {"a", "b", "c"}),
              UnorderedElementsAre(pair_of("a", "b", 100, 100), pair_of("b", "a", 100, 100),
                                   pair_of("a", "c", 100, 0), pair_of("b", "c", 100, 0),
                                   pair_of("c", "a", 100, 0), pair_of("c", "b", 100, 0)));
}

TEST(ViewConsistency, DirectionsInWhichTheOtherViewDoesNotMeasureDoNotCount) {
  test::ViewedSurfels wall;
  wall.add({{.view = 0, .height = 0, .beams = 100}, {.view = 1, .height = 0, .beams = 100}});
  wall.add({{.view = 0, .height = 0.9, .beams = 100}});  // a view's directions are its points here
  EXPECT_THAT(consistency_of(wall, {"a", "b"}),
              UnorderedElementsAre(pair_of("a", "b", 100, 100), pair_of("b", "a", 100, 100)));
}

TEST(ViewConsistency, UprightAndLevelSurfacesAreApart) {
  test::ViewedSurfels wall;
  wall.add({{.view = 0, .height = 0, .beams = 1000}, {.view = 1, .height = 0, .beams = 1000}});
  wall.add({{.view = 0, .height = 0.1, .beams = 100}, {.view = 1, .height = 0.19, .beams = 100}});
  wall.surfels.surfels[1].normal = {0, 0.8, 0.6};
  const auto pairs = consistency_of(wall, {"a", "b"});
  ASSERT_EQ(pairs.size(), 4U);
  for (const auto& pair : pairs) EXPECT_EQ(pair.share, pair.orientation == Orientation::level ? 1 : 0);
}

TEST(ViewConsistency, TheLeastConsistentPairIsReportedBelowAHalf) {
  const ViewPartition partition{.views = {"a", "b"}, .of_beam = {}, .advice = "turn it off and on again"};
  EXPECT_FALSE(inconsistency(partition, {}));
  EXPECT_FALSE(inconsistency(partition, {{"a", "b", Orientation::upright, 100, 0.5}}));
  EXPECT_THAT(inconsistency(partition, {{"a", "b", Orientation::upright, 100, 0.6},
                                        {"b", "a", Orientation::level, 100, 0.31}})
                  .value(),
              AllOf(HasSubstr("b and a agree on 31 % of the floors and ceilings"),
                    HasSubstr("expected above 70 %"), HasSubstr("turn it off and on again")));
}

TEST(ViewPartitions, DivideByLaserHalfAndQuarterOfEachRecording) {
  auto scanner = misplaced_scanner(1, 1.0);
  const auto recording = simulate_measurements(scanner, office());
  const Sample sample = sample_of(recording);
  const auto partitions = view_partitions(sample, {"laser1", "laser2", "laser3"});
  ASSERT_EQ(partitions.size(), 3U);
  std::vector<std::size_t> quarters(4);
  for (std::size_t i = 0; i < sample.beams.size(); ++i) {
    EXPECT_EQ(partitions[0].of_beam[i], sample.beams.laser[i]);
    EXPECT_EQ(partitions[1].of_beam[i], sample.beams.mirror_angle[i] > 0 ? 1U : 0U);
    ++quarters[partitions[2].of_beam[i]];
  }
  for (const std::size_t beams : quarters) {
    // The plate's readings go on for a quarter of a second before and after the beams: the outer quarters are
    // short.
    EXPECT_GT(static_cast<double>(beams), 0.1 * static_cast<double>(sample.beams.size()));
  }
  EXPECT_EQ(view_partitions(sample, {"laser1"}).size(), 2U);
}

}  // namespace
}  // namespace crisp
