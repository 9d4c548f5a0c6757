// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/trial.hpp"

#include <cmath>
#include <numbers>

#include "grabbers/simulate/paper.hpp"
#include "pipeline/data/degree.hpp"
#include "pipeline/data/error.hpp"
#include "plugins/calibrate/free_parameters.hpp"
#include "plugins/calibrate/in_plane_refinement.hpp"
#include "plugins/study/scene_bound.hpp"

namespace crisp {
namespace {

ScannerSettings scanner_of(const TrialSettings& settings, std::uint64_t seed) {
  ScannerSettings scanner{.seed = seed};
  scanner.rig.lasers.resize(settings.lasers);
  scanner.truth = draw_truth(nominal_calibration(scanner.rig), {.eta = settings.eta}, seed);
  scanner.duration = settings.duration;
  scanner.range.sigma = settings.noise;
  scanner.range.quantum = settings.quantum;
  return scanner;
}

Motion motion_of(const TrialSettings& settings, std::uint64_t seed) {
  return make_motion(settings.motion, settings.duration, settings.motion_seed.value_or(seed));
}

/// The least standard errors for exactly this recording's geometry.
Eigen::VectorXd bound_of(const TrialSettings& settings, std::uint64_t seed) {
  return scene_bound(scanner_of(settings, seed), paper_room(), motion_of(settings, seed),
                     BeamChoice::kInPlane)
      .std_errors;
}

Eigen::VectorXd errors(const SensorModel& found, const SensorModel& truth,
                       const std::vector<std::size_t>& free) {
  Eigen::VectorXd error = (found.values() - truth.values())(free);
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (!truth.names()[free[k]].ends_with(".lambda")) continue;
    double& turn = error[static_cast<Eigen::Index>(k)];
    turn = std::remainder(turn, 2 * std::numbers::pi);
  }
  return error;
}

/// Least squares against flat surfaces, from where RQE ended.
Estimate refine(const SensorModel& start, const SensorModel& truth, const Sample& sample,
                const std::vector<std::size_t>& free, const TrialSettings& settings) {
  try {
    const Refinement found = refine_in_plane(start, sample, free, settings.refinement);
    if (!found.converged) return {.failure = "the refinement did not converge"};
    return {.error = errors(found.outcome.model, truth, free),
            .std_error = found.outcome.covariance.diagonal().cwiseSqrt()};
  } catch (const Error& error) {
    return {.failure = error.message()};
  }
}

}  // namespace

TrialSettings::TrialSettings()
    : start{.tau = 0.02, .alpha = 3 * kDegree, .lambda = std::numbers::pi, .eta = 0} {}

Recording record(const TrialSettings& settings, std::uint64_t seed) {
  const ScannerSettings scanner = scanner_of(settings, seed);
  Recording recording{
      .simulated = simulate_beams(BeamChoice::kInPlane, scanner, paper_room(), motion_of(settings, seed)),
      .start = draw_truth(scanner.truth, settings.start, seed)};
  for (auto& laser : recording.start.lasers) laser.eta.value = 0;
  return recording;
}

Trial run_trial(const TrialSettings& settings, std::uint64_t seed, const MakeMeasure& make_measure) {
  const Recording recording = record(settings, seed);
  const SensorModel truth(recording.simulated.truth);
  SensorModel model(recording.start);
  const auto free = free_parameters(model, recording.simulated.beams, {}).free;
  Trial trial{.seed = seed, .bound = bound_of(settings, seed)};
  for (const auto parameter : free) trial.parameters.push_back(truth.names()[parameter]);

  const LagRange lag = lag_range(model, settings.in_plane.range.eta);
  const Sample sample = covered(recording.sample(), lag.earliest, lag.latest);
  const auto measure = make_measure();
  calibrate_in_plane(model, free, sample, *measure, settings.in_plane);
  trial.rqe.error = errors(model, truth, free);
  trial.refined = refine(model, truth, recording.sample(), free, settings);
  return trial;
}

}  // namespace crisp
