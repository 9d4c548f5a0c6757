// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/monte_carlo_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/encoder_smoothing.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "plugins/study/outliers.hpp"
#include "plugins/study/scene_bound.hpp"

namespace crisp::study {
namespace {

simulate::ScannerSettings scanner_of(const TrialSettings& settings, std::uint64_t seed) {
  simulate::ScannerSettings scanner{.rig = settings.rig, .seed = seed};
  scanner.rig.lasers.resize(settings.lasers);
  scanner.truth = simulate::draw_truth(nominal_calibration(scanner.rig), settings.truth, seed);
  scanner.duration = settings.duration;
  scanner.range.sigma = settings.noise;
  scanner.range.quantum = settings.quantum;
  scanner.laser_effects = settings.laser_effects;
  if (!scanner.laser_effects.empty()) scanner.laser_effects.resize(settings.lasers);
  return scanner;
}

double counted_noise(const TrialSettings& settings) {
  return settings.counted_noise.value_or(settings.noise);
}

simulate::Motion motion_of(const TrialSettings& settings, std::uint64_t seed) {
  return simulate::make_motion(settings.motion, settings.duration, settings.motion_seed.value_or(seed));
}

Calibration start_of(const TrialSettings& settings, const Calibration& truth, std::uint64_t seed) {
  if (settings.estimators == Estimators::kRefined) return simulate::draw_truth(truth, settings.near, seed);
  Calibration start = simulate::draw_truth(truth, settings.start, seed);
  for (auto& laser : start.lasers) laser.eta.value = 0;
  return start;
}

/// The least standard errors for exactly this recording's geometry.
SceneBound bound_of(const TrialSettings& settings, std::uint64_t seed) {
  simulate::ScannerSettings scanner = scanner_of(settings, seed);
  scanner.range.sigma = counted_noise(settings);
  return scene_bound(scanner, settings.scene, motion_of(settings, seed), settings.beams);
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

/// The minimum of RQE.
SensorModel rqe_minimizer(const SensorModel& start, const estimate::Sample& sample,
                          const std::vector<std::size_t>& free, const TrialSettings& settings,
                          Measure& measure) {
  if (settings.beams == BeamChoice::kAll)
    return calibrate::calibrate_by_rqe(start, sample, measure, settings.rqe).model;
  SensorModel model = start;
  const estimate::LagRange lag = estimate::lag_range(model, settings.rqe.in_plane.range.eta);
  calibrate::calibrate_in_plane(model, free, estimate::covered(sample, lag.earliest, lag.latest), measure,
                                settings.rqe.in_plane);
  return model;
}

/// Least squares against flat surfaces, from where RQE ended.
Estimate refine(const SensorModel& start, const SensorModel& truth, const estimate::Sample& sample,
                const std::vector<std::size_t>& free, const TrialSettings& settings) {
  try {
    estimate::RefinementSettings knowing = settings.refinement;
    knowing.surfels.noise = counted_noise(settings);
    const estimate::Refinement found = estimate::refine_by_surfels(start, sample, knowing);
    if (found.outcome.free != free) return {.failure = "the refinement held some parameters"};
    if (!found.converged) return {.failure = "the refinement did not converge"};
    return {.error = errors(found.outcome.model, truth, free),
            .std_error = found.outcome.covariance.diagonal().cwiseSqrt()};
  } catch (const Error& error) {
    return {.failure = error.message()};
  }
}

/// The plate's motion as the clock stages make it of its readings.
PlateTrajectory as_aligned(const PlateTrajectory& read, const RigPlate& plate) {
  const double step = std::abs(plate.angle_per_count());
  auto angles = data::between_steps(read.times(), read.angles(), step, kEncoderSmoothing);
  return {read.epoch_ns(), {read.times().begin(), read.times().end()}, std::move(angles), read.max_gap()};
}

}  // namespace

TrialSettings::TrialSettings()
    : start{.tau = 0.02, .alpha = 3 * data::kDegree, .lambda = std::numbers::pi, .eta = 0},
      near{.tau = 0.005, .alpha = 0.7 * data::kDegree, .lambda = 0.7 * data::kDegree, .eta = 3e-4} {}

void check_lasers(const TrialSettings& settings, const Rig& rig) {
  if (settings.lasers <= rig.lasers.size()) return;
  throw Error(fmt::format("the rig has {} lasers, and {} are requested", rig.lasers.size(), settings.lasers),
              "set `lasers` to the rig's number at most");
}

TrialRecording record(const TrialSettings& settings, std::uint64_t seed) {
  const simulate::ScannerSettings scanner = scanner_of(settings, seed);
  TrialRecording recording{
      .simulated = simulate_beams(settings.beams, scanner, settings.scene, motion_of(settings, seed)),
      .start = start_of(settings, scanner.truth, seed)};
  if (settings.outliers > 0) add_outliers(recording.simulated.beams, settings.outliers, seed);
  recording.simulated.plate = as_aligned(recording.simulated.plate, scanner.rig.plate);
  return recording;
}

double noise_in(const TrialSettings& settings, std::uint64_t seed) {
  const simulate::ScannerSettings scanner = scanner_of(settings, seed);
  const simulate::Motion motion = motion_of(settings, seed);
  const auto noisy = simulate_beams(settings.beams, scanner, settings.scene, motion).beams;
  const auto exact = simulate_beams(settings.beams, without_noise(scanner), settings.scene, motion).beams;
  std::map<std::pair<std::uint16_t, double>, float> exactly;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    exactly.emplace(std::pair(exact.laser[i], exact.time[i]), exact.range[i]);
  }
  double squares = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const auto found = exactly.find({noisy.laser[i], noisy.time[i]});
    if (found == exactly.end()) continue;  // noise can take a beam that is near, or give it
    squares += std::pow(double{noisy.range[i]} - double{found->second}, 2);
    ++n;
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, n)));
}

MonteCarloTrial run_trial(const TrialSettings& settings, std::uint64_t seed,
                          const MakeMeasure& make_measure) {
  const TrialRecording recording = record(settings, seed);
  const SensorModel truth(recording.simulated.truth);
  const estimate::Sample sample = recording.sample();
  SensorModel model(recording.start);
  const auto free = estimate::free_parameters(model, sample.beams, {}).free;
  const SceneBound bound = bound_of(settings, seed);
  MonteCarloTrial trial{.seed = seed, .bound = bound.std_errors, .bound_with_steps = bound.with_steps};
  for (const auto parameter : free) trial.parameters.push_back(truth.names()[parameter]);

  if (settings.estimators == Estimators::kBoth) {
    model = rqe_minimizer(model, sample, free, settings, *make_measure());
    trial.rqe = Estimate{.error = errors(model, truth, free)};
  }
  trial.refined = refine(model, truth, sample, free, settings);
  return trial;
}

}  // namespace crisp::study
