// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <Eigen/LU>

#include <crisp/error.hpp>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/parameter_prior.hpp"
#include "pipeline/estimate/requested_terms.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "tests/pipeline/estimate/support.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::simulate;

SensorModel with_terms(Calibration calibration, const std::vector<std::string>& requested) {
  add_requested_terms(calibration, requested, built_in_terms());
  return SensorModel(calibration, built_in_terms());
}

std::vector<std::string> names_of(const SensorModel& model, const std::vector<std::size_t>& parameters) {
  std::vector<std::string> names;
  for (const std::size_t i : parameters) names.push_back(model.names()[i]);
  return names;
}

TEST(RequestedTerms, AreAddedOnceToThePlateOrToTheLasersThatAreNamed) {
  const std::vector<std::string> requested = {"encoder.eccentricity", "laser2.mirror.cone"};
  Calibration calibration = nominal_calibration(default_rig());
  add_requested_terms(calibration, requested, built_in_terms());
  calibration.plate_terms.at(0).parameters.at(0).value = 0.003;
  add_requested_terms(calibration, requested, built_in_terms());
  ASSERT_EQ(calibration.plate_terms.size(), 1U);
  EXPECT_EQ(calibration.plate_terms[0].parameters[0].value, 0.003) << "what is there is a start";
  EXPECT_TRUE(calibration.lasers[0].terms.empty());
  EXPECT_EQ(calibration.lasers[1].terms.size(), 1U);
}

TEST(RequestedTerms, AreFreeButForTheirForms) {
  const std::vector<std::string> requested = {"range.cyclic", "laser3.mirror.cone"};
  const SensorModel model = with_terms(nominal_calibration(default_rig()), requested);
  EXPECT_EQ(names_of(model, parameters_of(model, {"laser3.mirror.cone"})),
            std::vector<std::string>{"laser3.mirror.cone.kappa"});
  EXPECT_EQ(
      names_of(model, parameters_of(model, {"range.cyclic"})),
      (std::vector<std::string>{"laser1.range.cyclic.a", "laser1.range.cyclic.b", "laser2.range.cyclic.a",
                                "laser2.range.cyclic.b", "laser3.range.cyclic.a", "laser3.range.cyclic.b"}));
  EXPECT_EQ(declared(model, 0), nullptr) << "λ";
}

TEST(ParameterPrior, OfAnAmplitudeIsAboutItsNeutralValueAndOfOthersAboutTheStart) {
  Calibration calibration = nominal_calibration(default_rig());
  add_requested_terms(calibration, {"laser1.range.cyclic"}, built_in_terms());
  auto& parameters = calibration.lasers[0].terms.at(0).parameters;  // a, b and the period P
  for (Parameter& parameter : parameters) parameter.value = 0.5;
  const SensorModel start(calibration, built_in_terms());
  const std::vector<std::size_t> some = {start.index("laser1.tau"), start.index("laser1.range.cyclic.a"),
                                         start.index("laser1.range.cyclic.P")};
  const Eigen::VectorXd means = prior_means({}, start, some);
  EXPECT_EQ(means[0], start.values()[static_cast<Eigen::Index>(some[0])]);
  EXPECT_EQ(means[1], 0);
  EXPECT_EQ(means[2], 0.5);
}

TEST(RequestedTerms, ThatAreNoneAreRefused) {
  Calibration calibration = nominal_calibration(default_rig());
  EXPECT_THROW(add_requested_terms(calibration, {"mirror.coin"}, built_in_terms()), Error);
  EXPECT_THROW(add_requested_terms(calibration, {"laser1.plate.wobble"}, built_in_terms()), Error);
  EXPECT_THROW(add_requested_terms(calibration, {"laser9.mirror.cone"}, built_in_terms()), Error);
}

TEST(SurfelRefinement, FindsTermsTogetherWithTheMounting) {
  ScannerSettings scanner = misplaced_scanner(1, 4.0);
  const std::vector<std::string> requested = {"encoder.eccentricity", "laser2.mirror.cone"};
  const SensorModel start = with_terms(scanner.truth, requested);
  add_requested_terms(scanner.truth, requested, built_in_terms());
  scanner.truth.plate_terms[0].parameters[0].value = 0.002;
  scanner.truth.plate_terms[0].parameters[1].value = -0.001;
  scanner.truth.lasers[1].terms[0].parameters[0].value = 0.003;
  const auto recording = simulate_measurements(scanner, office(), built_in_terms());
  const Refinement refined = refine_by_surfels(start, sample_of(recording), {.terms = requested});
  EXPECT_TRUE(refined.converged);
  EXPECT_TRUE(refined.outcome.unobservable.empty());
  const auto& free = refined.outcome.free;
  ASSERT_EQ(free.size(), 14U);
  const Eigen::VectorXd error =
      picked(refined.outcome.model, free) - picked(SensorModel(recording.truth, built_in_terms()), free);
  // χ² with 14 degrees of freedom is below 45 in all but one case of 20 000.
  EXPECT_LT(error.dot(refined.outcome.covariance.inverse() * error), 45);
}

TEST(SurfelRefinement, KeepsTermsWithinTheirBounds) {
  // Ranges settle at once: a step from a time constant of a second leads to one below zero, and from there
  // to infinity.
  ScannerSettings scanner = misplaced_scanner(1, 4.0);
  add_requested_terms(scanner.truth, {"laser2.range.warmup"}, built_in_terms());
  std::vector<Parameter>& warmup = scanner.truth.lasers[1].terms[0].parameters;
  warmup[0].value = -0.01;  // c
  warmup[1].value = 0.02;   // T
  const auto recording = simulate_measurements(scanner, office(), built_in_terms());
  Calibration start = recording.truth;
  start.lasers[1].terms[0].parameters[1].value = 1;
  const Refinement refined = refine_by_surfels(SensorModel(start, built_in_terms()), sample_of(recording),
                                               {.terms = {"laser2.range.warmup"}, .forms = true});
  const Eigen::VectorXd found = refined.outcome.model.values();
  EXPECT_TRUE(found.allFinite());
  const std::size_t at = refined.outcome.model.index("laser2.range.warmup.T");
  EXPECT_GE(found[static_cast<Eigen::Index>(at)], 0.5) << "as the term declares";
}

}  // namespace
}  // namespace crisp
