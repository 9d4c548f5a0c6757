// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/view_consistency.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;
using testing::AllOf;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// Walls in the planes x = const, and points on them of beams from the origin or from next to it.
class Walls {
 public:
  struct Part {
    std::uint32_t view = 0;
    double off = 0;        ///< [m] behind the wall
    int beams = 0;         ///< a millimetre apart
    double given = 0;      ///< [m] in y of where they were measured from, and of where they end
    bool is_on_it = true;  ///< whether they belong to the surfel
  };

  void add(double distance, const std::vector<Part>& parts) {
    Surfel surfel{.middle = {distance, 0, 0}, .normal = {1, 0, 0}, .u = {0, 1, 0}, .v = {0, 0, 1}};
    surfel.begin = static_cast<std::uint32_t>(surfels.members.size());
    for (const Part& part : parts) {
      for (int k = 0; k < part.beams; ++k) {
        if (part.is_on_it) surfels.members.push_back(static_cast<std::uint32_t>(views.size()));
        if (part.is_on_it) surfels.weights.push_back(1);
        views.push_back(part.view);
        add({distance + part.off, part.given + 1e-3 * k, 0.05}, {0, part.given, 0});
      }
    }
    surfel.end = static_cast<std::uint32_t>(surfels.members.size());
    surfels.surfels.push_back(surfel);
  }

  std::vector<ViewConsistency> consistency(const std::vector<std::string>& names, double angle = 0,
                                           const std::vector<std::size_t>& groups = {}) const {
    const BeamsView beams{.points = points_.view(), .directions = directions_.view(), .views = views};
    return view_consistency(surfels, beams,
                            {.views = names, .of_beam = views, .advice = {}, .groups = groups},
                            {.range = 0.01, .angle = angle});
  }

  Surfels surfels;
  std::vector<std::uint32_t> views;

 private:
  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& from) {
    const Eigen::Vector3d direction = (point - from).normalized();
    points_.x.push_back(point.x());
    points_.y.push_back(point.y());
    points_.z.push_back(point.z());
    directions_.x.push_back(direction.x());
    directions_.y.push_back(direction.y());
    directions_.z.push_back(direction.z());
  }

  Vectors points_;
  Vectors directions_;
};

auto pair_of(const std::string& view, const std::string& other, double beams, double agreed) {
  return AllOf(Field(&ViewConsistency::view, view), Field(&ViewConsistency::other, other),
               Field(&ViewConsistency::beams, beams),
               Field(&ViewConsistency::share, testing::DoubleNear(agreed / beams, 1e-9)));
}

TEST(ViewConsistency, CountsBeamsThatTheOtherViewMeetsAtTheSamePlace) {
  Walls walls;
  walls.add(2, {{.view = 0, .beams = 600}, {.view = 1, .off = 0.02, .beams = 600}});   // within 3 σ
  walls.add(20, {{.view = 0, .beams = 600}, {.view = 1, .off = 0.05, .beams = 500}});  // apart
  EXPECT_THAT(walls.consistency({"a", "b"}),
              UnorderedElementsAre(pair_of("a", "b", 1200, 600), pair_of("b", "a", 1100, 600)));
}

TEST(ViewConsistency, AViewThatTestsThroughASurfaceContradictsIt) {
  Walls walls;
  walls.add(2, {{.view = 0, .beams = 600}, {.view = 1, .off = 1, .beams = 600, .is_on_it = false}});
  EXPECT_THAT(walls.consistency({"a", "b"}), UnorderedElementsAre(pair_of("a", "b", 600, 0)));
}

TEST(ViewConsistency, IgnoresAViewThatEndsInFrontOrPassesNextTo) {
  Walls in_front;
  in_front.add(2, {{.view = 0, .beams = 600}, {.view = 1, .off = -0.5, .beams = 600, .is_on_it = false}});
  EXPECT_THAT(in_front.consistency({"a", "b"}), IsEmpty());
  // In the same directions, but from a metre aside: they pass where nothing was seen.
  Walls given;
  given.add(
      2, {{.view = 0, .beams = 600}, {.view = 1, .off = 1, .beams = 600, .given = 0.9, .is_on_it = false}});
  EXPECT_THAT(given.consistency({"a", "b"}), IsEmpty());
}

TEST(ViewConsistency, EachPairOfThreeIsComparedSoThatTwoWhichAgreeHideNoThird) {
  Walls walls;
  walls.add(2,
            {{.view = 0, .beams = 600}, {.view = 1, .beams = 600}, {.view = 2, .off = 0.05, .beams = 600}});
  EXPECT_THAT(walls.consistency({"a", "b", "c"}),
              UnorderedElementsAre(pair_of("a", "b", 600, 600), pair_of("b", "a", 600, 600),
                                   pair_of("a", "c", 600, 0), pair_of("b", "c", 600, 0),
                                   pair_of("c", "a", 600, 0), pair_of("c", "b", 600, 0)));
}

TEST(ViewConsistency, WhatThePlateMayBeTurnedByCountsWithTheDistance) {
  Walls walls;
  walls.add(20, {{.view = 0, .beams = 600}, {.view = 1, .off = 0.05, .beams = 600}});
  EXPECT_EQ(walls.consistency({"a", "b"})[0].share, 0);
  EXPECT_EQ(walls.consistency({"a", "b"}, 1e-3)[0].share, 1);  // 20 mm there
}

TEST(ViewConsistency, GroupsOfViewsAreComparedWithinThemselvesAndByFewerBeams) {
  Walls walls;
  walls.add(2,
            {{.view = 0, .beams = 300}, {.view = 1, .off = 0.05, .beams = 300}, {.view = 2, .beams = 300}});
  EXPECT_THAT(walls.consistency({"a", "b", "c"}), IsEmpty());
  EXPECT_THAT(walls.consistency({"a", "b", "c"}, 0, {0, 0, 1}),
              UnorderedElementsAre(pair_of("a", "b", 300, 0), pair_of("b", "a", 300, 0)));
}

TEST(ViewConsistency, UprightAndLevelSurfacesAreApart) {
  Walls walls;
  walls.add(2, {{.view = 0, .beams = 600}, {.view = 1, .beams = 600}});
  walls.add(20, {{.view = 0, .beams = 600}, {.view = 1, .off = 0.05, .beams = 600}});
  walls.surfels.surfels[1].normal = {0.6, 0, 0.8};
  const auto pairs = walls.consistency({"a", "b"});
  ASSERT_EQ(pairs.size(), 4U);
  for (const auto& pair : pairs) EXPECT_EQ(pair.share, pair.orientation == Orientation::upright ? 1 : 0);
}

TEST(ViewConsistency, TheLeastConsistentPairIsReportedBelowItsLimit) {
  const ViewPartition partition{.views = {"a", "b"}, .of_beam = {}, .advice = "turn it off and on again"};
  EXPECT_FALSE(inconsistency(partition, {}));
  EXPECT_FALSE(inconsistency(partition, {{"a", "b", Orientation::upright, 100, 0.71}}));
  EXPECT_THAT(inconsistency(partition, {{"a", "b", Orientation::upright, 100, 0.6},
                                        {"b", "a", Orientation::level, 100, 0.31}})
                  .value(),
              AllOf(HasSubstr("b and a agree on 31 % of the floors and ceilings"),
                    HasSubstr("expected above 70 %"), HasSubstr("turn it off and on again")));
}

TEST(ViewConsistency, TheViewThatAgreesWithNoOtherIsTheSuspect) {
  const ViewPartition partition{.views = {"a", "b", "c"}, .of_beam = {}, .advice = "check {}"};
  std::vector<ViewConsistency> pairs = {{"a", "b", Orientation::upright, 100, 0.9},
                                        {"b", "c", Orientation::upright, 100, 0.1},
                                        {"a", "c", Orientation::level, 100, 0.2}};
  EXPECT_THAT(inconsistency(partition, pairs).value(), HasSubstr("check c, which agrees with no other"));
  pairs.push_back({"b", "a", Orientation::level, 100, 0.3});
  EXPECT_THAT(inconsistency(partition, pairs).value(), HasSubstr("check both"));
}

TEST(ViewPartitions, DivideByLaserHalfQuarterOfEachRecordingAndRate) {
  auto scanner = misplaced_scanner(1, 1.0);
  const auto recording = simulate_measurements(scanner, office());
  const Sample sample = sample_of(recording);
  const auto partitions = view_partitions(sample, {"laser1", "laser2", "laser3"});
  ASSERT_EQ(partitions.size(), 4U);
  std::vector<std::size_t> quarters(4);
  for (std::size_t i = 0; i < sample.beams.size(); ++i) {
    EXPECT_EQ(partitions[0].of_beam[i], sample.beams.laser[i]);
    EXPECT_EQ(partitions[1].of_beam[i], sample.beams.mirror_angle[i] > 0 ? 1U : 0U);
    ++quarters[partitions[2].of_beam[i]];
  }
  for (const std::size_t beams : quarters) {
    // The encoder readings go on for a quarter of a second before and after the beams: the outer quarters are
    // short.
    EXPECT_GT(static_cast<double>(beams), 0.1 * static_cast<double>(sample.beams.size()));
  }
  EXPECT_EQ(view_partitions(sample, {"laser1"}).size(), 3U);
}

TEST(ViewPartitions, SplitALasersBeamsByTheRateOfThePlate) {
  auto scanner = misplaced_scanner(1, 8.0);
  scanner.motion.kind = MotionKind::stop_and_go;
  const auto recording = simulate_measurements(scanner, office());
  const Sample sample = sample_of(recording);
  const ViewPartition partition = view_partitions(sample, {"laser1", "laser2", "laser3"}).back();
  ASSERT_EQ(partition.views.size(), 6U);
  std::vector<std::size_t> beams(6);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < sample.beams.size(); ++i) {
    constexpr double kSlow = 1, kFast = 12;  // [rad/s] of 0 and 12.6 where it stands and turns
    const double rate = sample.plate->at(sample.beams.time[i])->rate;
    const std::uint32_t view = partition.of_beam[i];
    ++beams[view];
    if (view / 2 != sample.beams.laser[i]) ++wrong;
    if (rate < kSlow && view % 2 != 0) ++wrong;
    if (rate > kFast && view % 2 != 1) ++wrong;
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_THAT(beams, testing::Each(testing::Gt(1000U)));
  EXPECT_THAT(partition.groups, testing::ElementsAre(0, 0, 1, 1, 2, 2));
}

TEST(ViewPartitions, DoNotSplitByAConstantRate) {
  auto scanner = misplaced_scanner(1, 2.0);
  scanner.motion.kind = MotionKind::constant;
  const auto recording = simulate_measurements(scanner, office());
  EXPECT_EQ(view_partitions(sample_of(recording), {"laser1", "laser2", "laser3"}).size(), 3U);
}

}  // namespace
}  // namespace crisp
