// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/trial.hpp"

#include <cmath>
#include <numbers>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/paper.hpp"
#include "grabbers/simulate/ray_caster.hpp"
#include "pipeline/data/degree.hpp"
#include "pipeline/data/error.hpp"
#include "plugins/calibrate/bound.hpp"
#include "plugins/calibrate/free_parameters.hpp"
#include "plugins/calibrate/in_plane_refinement.hpp"
#include "plugins/calibrate/placed_beams.hpp"

namespace crisp {
namespace {

ScannerSettings scanner_of(const TrialSettings& settings, std::uint64_t seed) {
  ScannerSettings scanner = paper_scanner(seed);
  scanner.rig.lasers.resize(settings.lasers);
  scanner.truth = draw_truth(nominal_calibration(scanner.rig), {.eta = settings.eta}, seed);
  scanner.duration = settings.duration;
  scanner.range.sigma = settings.noise;
  scanner.range.quantum = settings.quantum;
  return scanner;
}

SimulatedMeasurements simulate(const TrialSettings& settings, const ScannerSettings& scanner,
                               const Scene& room) {
  const Motion motion =
      make_motion(settings.motion, settings.duration, settings.motion_seed.value_or(scanner.seed));
  return simulate_measurements(scanner, room, motion);
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
  Recording recording{.simulated = simulate(settings, scanner, paper_room()),
                      .start = draw_truth(scanner.truth, settings.start, seed)};
  for (auto& laser : recording.start.lasers) laser.eta.value = 0;
  return recording;
}

Eigen::VectorXd bound_of(const TrialSettings& settings, std::uint64_t seed,
                         const std::vector<std::size_t>& free) {
  ScannerSettings scanner = scanner_of(settings, seed);
  scanner.range.sigma = 0;
  scanner.range.quantum = 0;
  scanner.encoder_quantised = false;
  const Scene room = paper_room();
  const auto exact = simulate(settings, scanner, room);
  const Sample sample{.beams = exact.beams, .plate = &exact.plate};
  const SensorModel truth(exact.truth);

  std::vector<Eigen::Vector3d> normals;
  for (const auto& surface : room.surfaces) {
    const auto& corner = surface.corners;
    normals.push_back((corner[1] - corner[0]).cross(corner[2] - corner[1]).normalized());
  }
  const RayCaster caster(room);
  const PlacedBeams placed(truth, sample);
  const BeamsView beams = placed.view();
  std::vector<std::uint32_t> surface;
  for (std::size_t i = 0; i < sample.beams.size(); ++i) {
    const Eigen::Vector3d direction(beams.directions.x[i], beams.directions.y[i], beams.directions.z[i]);
    const Eigen::Vector3d end(beams.points.x[i], beams.points.y[i], beams.points.z[i]);
    constexpr double kBack = 0.05;  // [m] before the end
    const auto hit = caster.cast({end - kBack * direction, direction}, 2 * kBack);
    if (!hit) throw Error("a simulated beam does not end on a surface");
    surface.push_back(hit->surface);
  }
  return least_std_errors(calibration_information(truth, sample, surface, normals, free, settings.noise));
}

Trial run_trial(const TrialSettings& settings, std::uint64_t seed, const MakeMeasure& make_measure) {
  const Recording recording = record(settings, seed);
  const SensorModel truth(recording.simulated.truth);
  SensorModel model(recording.start);
  const auto free = free_parameters(model, recording.simulated.beams, {}).free;
  Trial trial{.seed = seed, .bound = bound_of(settings, seed, free)};
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
