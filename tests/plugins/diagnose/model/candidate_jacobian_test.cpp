// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/candidate_jacobian.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include "plugins/diagnose/model/surface_observations.hpp"
#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;

std::vector<std::string> names(const std::vector<Candidate>& candidates) {
  std::vector<std::string> all;
  for (const auto& candidate : candidates) all.push_back(candidate.name);
  return all;
}

TEST(Candidates, AreEachTermOfEachOwnerInEachForm) {
  const auto all = candidates(built_in_terms(), nominal_calibration(default_rig()), {0, 10});
  const auto count = [&](const std::string& name) { return std::ranges::count(names(all), name); };
  EXPECT_EQ(count("encoder.eccentricity"), 1);
  EXPECT_EQ(count("laser1.mirror.cone"), 1);
  EXPECT_EQ(count("laser3.mirror.cone"), 1);
  EXPECT_EQ(count("mirror.cone"), 0);
  EXPECT_EQ(count("laser2.range.step"), 19);
  const auto step = std::ranges::find(all, "laser2.range.step", &Candidate::name);
  EXPECT_NEAR(step->term.parameters.at(1).value, 0.5, 1e-12) << "a twentieth of the recording";
}

TEST(Candidates, ThatRecordingsCannotShareAreLeftOutAndReported) {
  const auto left = [](const Coverage& coverage) {
    return names(candidates(built_in_terms(), nominal_calibration(default_rig()), coverage));
  };
  using testing::Contains;
  using testing::Not;
  const Coverage apart{.first = 0, .last = 10, .one_begin = false};
  EXPECT_THAT(left(apart), Not(Contains("laser1.range.warmup")));
  EXPECT_THAT(left(apart), Not(Contains("laser1.empirical.range_by_time")));
  EXPECT_THAT(left(apart), Contains("encoder.eccentricity"));
  EXPECT_THAT(unshared_causes(built_in_terms(), apart),
              testing::UnorderedElementsAre("base.motion", "clock.drift", "range.step", "range.warmup"));
  const Coverage anew{.first = 0, .last = 10, .one_begin = false, .one_zero = false};
  EXPECT_THAT(left(anew), Not(Contains("encoder.eccentricity")));
  EXPECT_THAT(left(anew), Not(Contains("plate.wobble")));
  EXPECT_THAT(left(anew), Contains("encoder.speed_lag"));
  EXPECT_THAT(left(anew), Contains("laser1.mirror.cone"));
}

TEST(Candidates, OfTheModelKeepTheirFormAndValues) {
  Calibration calibration = nominal_calibration(default_rig());
  add_requested_terms(calibration, {"laser2.range.step"}, built_in_terms());
  test::term_of(calibration, "laser2.range.step").parameters = {{.name = "h", .unit = "m", .value = 0.01},
                                                                {.name = "at", .unit = "s", .value = 3}};
  const auto all = candidates(built_in_terms(), calibration, {0, 10});
  EXPECT_EQ(std::ranges::count(names(all), "laser2.range.step"), 1);
  const auto step = std::ranges::find(all, "laser2.range.step", &Candidate::name);
  EXPECT_TRUE(step->in_model);
  EXPECT_EQ(step->term.parameters.at(1).value, 3);
}

/// Displacement of a surfel's beams along its normal per unit of one parameter of a term.
Eigen::VectorXd moved(const Calibration& plain, const Candidate& candidate, std::size_t parameter,
                      double step, const Surfel& surfel, const Sample& beams) {
  const auto placed_with = [&](double by) {
    Calibration calibration = plain;
    Candidate changed = candidate;
    changed.term.parameters[parameter].value += by;
    add_to(calibration, changed);
    const SensorModel model(calibration, built_in_terms());
    const Placed placed = model.place(beams.beams, *beams.plate);
    return Eigen::VectorXd(placed.points.transpose() * surfel.normal);
  };
  return (placed_with(step) - placed_with(-step)) / (2 * step);
}

/// Compares each column of what the model lacks with finite differences.
void expect_derivatives(const Calibration& plain) {
  const auto recording = test::hidden(3, 2, office(), {});
  const SensorModel model(plain, built_in_terms());
  const Sample inside = covered(recording.sample(), -0.05, 0.05);
  const Sample sample = select(inside, [](std::size_t i) { return i % 997 == 0; });
  const CandidateJacobian jacobian(model, {1, 2, 3, 4, 5}, candidates(built_in_terms(), plain, {0, 2}),
                                   built_in_terms());
  Surfel surfel;
  surfel.normal = Eigen::Vector3d(0.6, 0.64, 0.48);
  std::vector<std::uint32_t> beams(sample.beams.size());
  std::iota(beams.begin(), beams.end(), 0U);
  const std::vector<double> stay(beams.size(), 0);
  std::vector<double> rows(beams.size() * jacobian.parameters(), 0);
  jacobian.rows(sample)(surfel, beams, stay, rows);
  for (std::size_t c = 0; c < jacobian.candidates().size(); ++c) {
    const Candidate& candidate = jacobian.candidates()[c];
    if (candidate.in_model) continue;
    const auto& declared = built_in_terms().get(candidate.term.term)->info().parameters;
    std::size_t k = 0;
    for (std::size_t p = 0; p < declared.size(); ++p) {
      if (declared[p].shape) continue;
      const double step = 1e-6 * (declared[p].upper - declared[p].lower);
      const std::size_t column = jacobian.of(c).at(k++);
      const Eigen::VectorXd expected = moved(plain, candidate, p, step, surfel, sample);
      for (std::size_t i = 0; i < beams.size(); ++i) {
        const double requested = expected[static_cast<Eigen::Index>(i)];
        EXPECT_NEAR(rows[i * jacobian.parameters() + column], requested, 1e-4 * (1 + std::abs(requested)))
            << candidate.name << '.' << declared[p].name << ", beam " << i;
      }
    }
  }
}

TEST(CandidateJacobian, HoldsTheDerivativeOfEachParameterInItsColumn) {
  expect_derivatives(nominal_calibration(default_rig()));
}

TEST(CandidateJacobian, HoldsTheDerivativesInAModelWithTermsOfEveryPhase) {
  Calibration calibration = nominal_calibration(default_rig());
  const std::vector<std::string> terms = {"laser1.timing.intra_scan",
                                          "encoder.eccentricity",
                                          "laser2.mirror.eccentricity",
                                          "laser1.mirror.cone",
                                          "laser3.mount.tangential_offset",
                                          "plate.wobble",
                                          "base.tilt",
                                          "laser2.range.scale"};
  add_requested_terms(calibration, terms, built_in_terms());
  for (const std::string& term : terms) {
    TermParameters& given = test::term_of(calibration, term);
    const auto& declared = built_in_terms().get(given.term)->info().parameters;
    for (std::size_t k = 0; k < declared.size(); ++k)
      given.parameters[k].value += 1e-3 * std::min(1.0, declared[k].upper - declared[k].lower);
  }
  expect_derivatives(calibration);
}

TEST(CandidateJacobian, HasTheSizesOfTheModelsOwnTerms) {
  Calibration calibration = nominal_calibration(default_rig());
  add_requested_terms(calibration, {"encoder.eccentricity", "laser1.range.cyclic"}, built_in_terms());
  test::term_of(calibration, "encoder.eccentricity").parameters[1].value = 0.003;
  const SensorModel model(calibration, built_in_terms());
  const auto all = candidates(built_in_terms(), calibration, {0, 10});
  const CandidateJacobian jacobian(model, {1, 2}, all, built_in_terms());
  const auto at = static_cast<std::size_t>(std::ranges::find(all, "encoder.eccentricity", &Candidate::name) -
                                           all.begin());
  EXPECT_EQ(jacobian.sizes_of(at), Eigen::Vector2d(0, 0.003));
}

}  // namespace
}  // namespace crisp
