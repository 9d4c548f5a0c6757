// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surface_map.hpp"

#include <gmock/gmock.h>

#include <Eigen/Core>

#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::simulate;

/// Two lasers whose beams alternate, one a millisecond.
Measurements alternating(std::size_t n) {
  Measurements beams;
  for (std::size_t i = 0; i < n; ++i) {
    const auto pair = i / 2;
    beams.time.push_back(1e-3 * static_cast<double>(pair));
    beams.laser.push_back(static_cast<std::uint16_t>(i % 2));
    beams.range.push_back(1);
    beams.mirror_angle.push_back(0);
    beams.remission.push_back(0);
    beams.beam.push_back(0);
  }
  return beams;
}

TEST(SurfaceMapTest, KeepsSurfacesWithTheBeamsOfASelection) {
  const Measurements all = alternating(8);
  quality::Surfels surfels;
  surfels.add({.radius = 1}, std::vector<std::uint32_t>{0, 3, 4, 7});
  surfels.add({.radius = 2}, std::vector<std::uint32_t>{1, 2});
  surfels.weights = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  const SurfaceMap map(all, surfels, {1, 2, 3, 4, 5, 6, 7, 8});
  Measurements some;
  for (const std::size_t i : {3, 4, 5, 7}) some.append(all, i);
  const SurfaceMap::Selection selection = map.of(some);
  ASSERT_EQ(selection.surfels.surfels.size(), 1U);  // the other has no beam among them
  EXPECT_EQ(selection.surfels.surfels[0].radius, 1);
  EXPECT_THAT(selection.surfels.beams_of(selection.surfels.surfels[0]), testing::ElementsAre(0U, 1U, 3U));
  EXPECT_THAT(selection.surfels.weights, testing::ElementsAre(0.2, 0.3, 0.4));
  EXPECT_THAT(selection.noise, testing::ElementsAre(4, 5, 6, 8));
}

TEST(SurfaceMapTest, LeavesBeamsItDoesNotKnowWithoutASurface) {
  const Measurements all = alternating(6);
  Measurements first;
  for (const std::size_t i : {0, 1, 2}) first.append(all, i);
  quality::Surfels surfels;
  surfels.add({}, std::vector<std::uint32_t>{0, 1, 2});
  const SurfaceMap::Selection selection = SurfaceMap(first, surfels, {2, 2, 2}).of(all);
  EXPECT_THAT(selection.surfels.members, testing::ElementsAre(0U, 1U, 2U));
  EXPECT_THAT(selection.noise, testing::ElementsAre(2, 2, 2, 1, 1, 1));
}

/// Moves all parameters but the gauge by as many of their standard errors.
SensorModel moved(const Outcome& outcome, double standard_errors) {
  Eigen::VectorXd values = picked(outcome.model, outcome.free);
  double sign = 1;
  for (Eigen::Index k = 0; k < values.size(); ++k, sign = -sign)
    values[k] += sign * standard_errors * std::sqrt(outcome.covariance(k, k));
  return with(outcome.model, outcome.free, values);
}

/// [standard errors] of the parameter in which two refinements differ most.
double difference(const Refinement& one, const Refinement& other) {
  const Eigen::VectorXd apart =
      picked(one.outcome.model, one.outcome.free) - picked(other.outcome.model, one.outcome.free);
  return apart.cwiseQuotient(one.outcome.covariance.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
}

class KnownSurfaces : public testing::Test {
 protected:
  const SimulatedMeasurements recording_ = simulate_measurements(misplaced_scanner(1, 4.0), office());
  const Sample sample_ = sample_of(recording_);
  const Refinement fit_ = refine_by_surfels(SensorModel(recording_.truth), sample_, {});
};

TEST_F(KnownSurfaces, LeadToTheModelThatASearchLeadsTo) {
  const SensorModel start = moved(fit_.outcome, 5);
  const Refinement searched = refine_by_surfels(start, sample_, {});
  const Refinement known = refine_by_surfels(start, sample_, {}, {}, fit_.surfaces);
  EXPECT_TRUE(known.converged);
  EXPECT_LT(difference(searched, known), 0.5);  // one of the surfaces may count in one of them only
  EXPECT_LE(known.rounds, searched.rounds);
  EXPECT_NEAR(static_cast<double>(known.beams), static_cast<double>(searched.beams), 0.002 * searched.beams);
}

TEST_F(KnownSurfaces, AreSearchedAnewWhereTheModelBeforeWasWrong) {
  // A step that is no step: the surfaces are those of the start, tens of millimetres off.
  RefinementSettings one_round;
  one_round.max_rounds = 1;
  one_round.searches = 1;
  const Refinement far = refine_by_surfels(moved(fit_.outcome, 100), sample_, one_round);
  const Refinement known = refine_by_surfels(fit_.outcome.model, sample_, {}, {}, far.surfaces);
  EXPECT_TRUE(known.converged);
  EXPECT_LT(difference(fit_, known), 0.5);
}

}  // namespace
}  // namespace crisp
