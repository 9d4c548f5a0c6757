// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_hypotheses.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <utility>

#include <crisp/effect_catalogue.hpp>

#include "pipeline/data/mirror_angle.hpp"
#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/requested_terms.hpp"
#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::data;
using namespace crisp::estimate;
using namespace crisp::simulate;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A recording in the office, and what a rig that is wrong makes of it.
class RigHypotheses : public testing::Test {
 protected:
  RigHypotheses() {
    register_built_in(terms_);
    ScannerSettings scanner = misplaced_scanner(2, 5);
    for (LaserCalibration& laser : scanner.truth.lasers) laser.eta.value /= 10;
    simulated_ = simulate_measurements(scanner, office());
  }

  /// The data as a rig reads them whose mounts are greater by so much than the true ones.
  Sample with_mounts(const std::vector<double>& greater) {
    Sample sample = sample_of(simulated_);
    for (std::size_t i = 0; i < sample.beams.size(); ++i) {
      float& angle = sample.beams.mirror_angle[i];
      angle = static_cast<float>(wrapped_mirror_angle(angle - greater[sample.beams.laser[i]]));
    }
    return sample;
  }
  Rig rig_with_mounts(const std::vector<double>& greater) const {
    Rig rig = default_rig();
    for (std::size_t i = 0; i < greater.size(); ++i) rig.lasers[i].mount += greater[i];
    return rig;
  }
  HypothesisSettings settings() { return {.terms = &terms_, .measure = measure_.get(), .refinement = {}}; }

  TermRegistry terms_;
  std::unique_ptr<Measure> measure_ = rqe_measure();
  SimulatedMeasurements simulated_;
};

TEST_F(RigHypotheses, AMountThatIsOffByADegreeIsFound) {
  const std::vector<double> off = {0, 1 * kDegree, 0};
  const auto caveats =
      check_mounts(SensorModel(simulated_.truth, terms_), with_mounts(off), rig_with_mounts(off), settings());
  EXPECT_THAT(caveats, ElementsAre(AllOf(HasSubstr("laser2's mount is off: 45.00"),
                                         HasSubstr("the rig has 46.000 deg"))));
}

TEST_F(RigHypotheses, AMountThatTheModelEstimatesIsNotSuspected) {
  const std::vector<double> off = {0, 1 * kDegree, 0};
  Calibration truth = simulated_.truth;
  add_requested_terms(truth, {"laser2.mount.mirror_zero"}, terms_);
  EXPECT_THAT(check_mounts(SensorModel(truth, terms_), with_mounts(off), rig_with_mounts(off), settings()),
              IsEmpty());
}

TEST_F(RigHypotheses, AMountIsNamedTogetherWithTheDirectionThatHidesIt) {
  const std::vector<double> off = {0, 3 * kDegree, 0};
  Sample sample = with_mounts(off);
  const PlateTrajectory plate = reversed(*sample.plate);
  sample.plate = &plate;
  const Rig rig = rig_with_mounts(off);
  EXPECT_THAT(
      RigErrorSearch(sample, rig, settings()).any().value_or(""),
      AllOf(HasSubstr("plate.direction: clockwise, and mount: 45"), HasSubstr("of laser2 (the rig has 48)")));
}

TEST_F(RigHypotheses, MountsThatAreRightAreNotSuspected) {
  const std::vector<double> off(3, 0.0);
  EXPECT_THAT(
      check_mounts(SensorModel(simulated_.truth, terms_), with_mounts(off), default_rig(), settings()),
      IsEmpty());
}

TEST(RigHypothesesOfCounts, HalfAPercentTooManyIsFoundByTheBeamsThatFit) {
  TermRegistry terms;
  register_built_in(terms);
  const auto measure = rqe_measure();
  const HypothesisSettings settings{.terms = &terms, .measure = measure.get(), .refinement = {}};
  ScannerSettings scanner = misplaced_scanner(8, 5);
  for (LaserCalibration& laser : scanner.truth.lasers) laser.eta.value /= 10;
  const SimulatedMeasurements simulated = simulate_measurements(scanner, office());
  Sample sample = sample_of(simulated);
  EXPECT_FALSE(RigErrorSearch(sample, default_rig(), settings).counts()) << "counts that are right";
  std::vector<double> angles;
  for (const double angle : sample.plate->angles()) angles.push_back(angle / 1.006);
  const PlateTrajectory slower = sample.plate->with_angles(std::move(angles));
  sample.plate = &slower;
  const auto mistake = RigErrorSearch(sample, default_rig(), settings).counts();
  ASSERT_TRUE(mistake);
  EXPECT_THAT(*mistake, HasSubstr("multiply it by 0.994"));
}

TEST_F(RigHypotheses, ARigThatFitsAsItStandsHasNoMistake) {
  EXPECT_FALSE(RigErrorSearch(sample_of(simulated_), default_rig(), settings()).any());
}

TEST_F(RigHypotheses, MountsThatAreAllOffByARightAngleAreFoundFromTheRigsNominalValues) {
  const std::vector<double> off(3, -90 * kDegree);
  const auto mistake = RigErrorSearch(with_mounts(off), rig_with_mounts(off), settings()).any();
  ASSERT_TRUE(mistake);
  EXPECT_THAT(*mistake, AllOf(HasSubstr("mount: 45deg of laser1 (the rig has -45)"),
                              HasSubstr("mount: 45deg of laser3 (the rig has -45)")));
}

TEST_F(RigHypotheses, ExchangedLasersAreFoundFromTheRigsNominalValues) {
  Rig rig = default_rig();
  std::swap(rig.lasers[0].nominal, rig.lasers[1].nominal);
  std::swap(rig.lasers[0].nominal.name, rig.lasers[1].nominal.name);
  const auto mistake = RigErrorSearch(sample_of(simulated_), rig, settings()).any();
  ASSERT_TRUE(mistake);
  EXPECT_THAT(*mistake, HasSubstr("the addresses of laser1 and laser2 exchanged"));
}

TEST_F(RigHypotheses, CountsThatAreOffByAFactorOfFourAreFoundInLessThanATurn) {
  Sample sample = sample_of(simulated_);
  std::vector<double> angles;
  for (const double angle : sample.plate->angles()) angles.push_back(angle / 4);
  const PlateTrajectory slower = sample.plate->with_angles(std::move(angles));
  sample.plate = &slower;
  const auto mistake = RigErrorSearch(sample, default_rig(), settings()).any();
  ASSERT_TRUE(mistake);
  EXPECT_THAT(*mistake, HasSubstr(fmt::format("plate.counts_per_revolution: {:.10g}",
                                              default_rig().plate.counts_per_revolution / 4)));
}

}  // namespace
}  // namespace crisp
