// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/effect_resolution.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "pipeline/estimate/free_parameters.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"
#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::quality;
using namespace crisp::simulate;

constexpr double kPlannedBeams = 300'000;

/// Equations of a short recording in the office, as they would be without noise.
struct Planned {
  CandidateJacobian jacobian;
  NormalEquations equations;
};

Planned planned() {
  const auto recording = test::hidden(4, 4, office(), {});
  const SensorModel model(recording.made.truth, built_in_terms());
  const SurfaceObservations observations(model, covered(recording.sample(), -0.05, 0.05), {}, 30'000);
  CandidateJacobian jacobian(
      model, free_parameters(model, recording.made.beams, {}).free,
      typical_causes(candidates(built_in_terms(), recording.made.truth, observations.coverage())),
      built_in_terms());
  NormalEquations equations = planned_with(observations.equations(jacobian, 30'000), kPlannedBeams);
  return {.jacobian = std::move(jacobian), .equations = std::move(equations)};
}

/// The equations of a recording with an effect of this size [m], whose cause has one parameter.
NormalEquations with_effect(const Planned& planned, std::size_t cause, double size,
                            const EffectResolution& resolution) {
  NormalEquations equations = planned.equations;
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(equations.vector.size());
  truth[static_cast<Eigen::Index>(planned.jacobian.of(cause).front())] = size * resolution.per_metre;
  equations.vector = -(equations.matrix * truth);
  equations.chi2 = truth.dot(equations.matrix * truth);
  return equations;
}

std::size_t place_of(const std::string& cause, const CandidateJacobian& jacobian) {
  const auto& all = jacobian.candidates();
  const auto found = std::ranges::find_if(
      all, [&](const Candidate& one) { return one.cause_name() == cause && !one.is_shape(); });
  return static_cast<std::size_t>(found - all.begin());
}

/// Names of the causes that the selection takes, with those that it does not resolve from the first one.
std::set<std::string> causes_of(const std::vector<SelectedCandidate>& selected,
                                const CandidateJacobian& jacobian, double odds) {
  std::set<std::string> causes;
  for (const SelectedCandidate& one : selected) {
    causes.insert(jacobian.candidates()[one.candidate].cause_name());
    for (const CompetingCandidate& other : one.alternatives) {
      if (other.behind < odds) causes.insert(jacobian.candidates()[other.candidate].cause_name());
    }
  }
  return causes;
}

TEST(EffectResolution, IsWhereTheSelectionFindsAnEffectAndResolvesIt) {
  const Planned all = planned();
  const SelectionSettings settings;
  int found = 0;
  for (const EffectResolution& effect : effect_resolutions(all.jacobian, all.equations, settings)) {
    if (effect.parameter.empty() || !std::isfinite(effect.detectable)) continue;
    const std::size_t cause = place_of(effect.cause, all.jacobian);
    if (all.jacobian.candidates()[cause].forms > 1) continue;
    const auto selected_at = [&](double size) {
      return causes_of(choose(all.jacobian, with_effect(all, cause, size, effect), settings), all.jacobian,
                       settings.odds);
    };
    EXPECT_THAT(selected_at(0.9 * effect.detectable), testing::IsEmpty()) << effect.cause;
    EXPECT_THAT(selected_at(1.1 * effect.detectable), testing::Not(testing::IsEmpty())) << effect.cause;
    if (std::isfinite(effect.resolvable)) {
      EXPECT_THAT(selected_at(1.1 * effect.resolvable), testing::ElementsAre(effect.cause));
    }
    ++found;
  }
  EXPECT_GT(found, 10);
}

TEST(EffectResolution, PartsAnEncodersErrorFromABearings) {
  const Planned all = planned();
  const auto effects = effect_resolutions(all.jacobian, all.equations, {});
  const auto found = std::ranges::find(effects, "encoder.eccentricity", &EffectResolution::cause);
  ASSERT_NE(found, effects.end());
  EXPECT_LT(found->resolvable, 0.002) << "m: it turns the plate about its axis, as no bearing does";
  EXPECT_THAT(found->confounded_with, testing::Not(testing::Contains("plate.wobble")));
}

TEST(EffectResolution, IsFinerWithMoreBeamsUpToWhatIsVisible) {
  const Planned all = planned();
  SelectionSettings settings;
  settings.visible = 0;
  settings.untested = 0;
  const auto with = [&](double beams) {
    return effect_resolutions(all.jacobian, planned_with(all.equations, beams), settings);
  };
  const auto few = with(1e4);
  const auto many = with(1e6);
  ASSERT_EQ(few.size(), many.size());
  for (std::size_t k = 0; k < few.size(); ++k) {
    if (!std::isfinite(few[k].detectable)) continue;
    const double gain = few[k].detectable / many[k].detectable;
    EXPECT_GT(gain, 7) << few[k].cause << ": ten, but for the price of a parameter";
    EXPECT_LE(gain, 10) << few[k].cause;
    EXPECT_GE(few[k].resolvable, few[k].detectable) << few[k].cause;
  }
}

}  // namespace
}  // namespace crisp
