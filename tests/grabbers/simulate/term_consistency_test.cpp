// SPDX-License-Identifier: BSD-3-Clause
// What a simulation hides by a term, the model with the same term undoes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <crisp/sensor_model.hpp>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/nominal_errors.hpp"
#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;

/// A twentieth of the way to the upper bound for sizes, the neutral value for forms.
Effect moderate(const TermInfo& info) {
  Effect effect{.name = info.name, .owner = {}, .values = {}, .place = {}};
  for (const auto& p : info.parameters) {
    if (!p.shape) effect.values.emplace_back(p.name, p.neutral + (p.upper - p.neutral) / 20);
  }
  return effect;
}

SimulatedMeasurements simulated(const std::vector<Effect>& effects) {
  ScannerSettings settings;
  settings.range = {.sigma = 0, .quantum = 0, .max_distance = 50};
  settings.encoder_quantised = false;
  settings.plate_frequency = 2000;
  settings.duration = 1;
  settings.field.step *= 4;
  settings.truth.lasers[1].eta.value = 0.01;
  add_terms(settings.truth, effects, built_in_terms());
  auto result = simulate_measurements(settings, office(), built_in_terms());
  result.beams.cos_incidence = result.cos_incidence;
  return result;
}

/// How far the placed points are from the scene's surfaces, at worst [m].
double worst_distance(const SimulatedMeasurements& measured, const Calibration& calibration) {
  const RayCaster scene(office());
  const auto placed = SensorModel(calibration, built_in_terms()).place(measured.beams, measured.plate);
  EXPECT_EQ(placed.index.size(), measured.beams.size());
  double worst = 0;
  for (Eigen::Index i = 0; i < placed.points.cols(); ++i) {
    worst = std::max(worst, scene.distance(placed.points.col(i)));
  }
  return worst;
}

class TermConsistency : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(BuiltIn, TermConsistency, testing::ValuesIn(built_in_terms().names()),
                         [](const auto& name) {
                           std::string text = name.param;
                           std::replace(text.begin(), text.end(), '.', '_');
                           return text;
                         });

TEST_P(TermConsistency, TheTruthPutsEveryPointOnASurface) {
  const auto& info = built_in_terms().get(GetParam())->info();
  const auto measured = simulated({moderate(info)});
  ASSERT_GT(measured.beams.size(), 15'000U);
  // Ranges and mirror angles are floats: 1e-7 rad and 1e-6 m, on slanting walls some metres away.
  EXPECT_LT(worst_distance(measured, measured.truth), 3e-5);
  Calibration without = measured.truth;
  without.plate_terms.clear();
  for (auto& laser : without.lasers) laser.terms.clear();
  EXPECT_GT(worst_distance(measured, without), 3e-4) << "the effect is there";
}

}  // namespace
}  // namespace crisp
