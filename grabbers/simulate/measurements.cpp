// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/measurements.hpp"

#include <cmath>

#include "grabbers/simulate/sweep.hpp"
#include "pipeline/data/mirror_angle.hpp"

namespace crisp::simulate {
namespace {

constexpr double kMargin = 0.25;                            // [s] of encoder readings beyond the beams
constexpr std::int64_t kEpoch = 1'767'225'600'000'000'000;  // 2026-01-01 00:00 UTC: any date will do

PlateTrajectory read_encoder(const ScannerSettings& settings, const Motion& motion) {
  check_plate_frequency(settings);
  const double step = settings.rig.plate.angle_per_count();
  const auto readings =
      static_cast<std::size_t>(std::ceil((settings.duration + 2 * kMargin) * settings.plate_frequency)) + 1;
  std::vector<double> times;
  std::vector<double> angles;
  for (std::size_t i = 0; i < readings; ++i) {
    times.push_back(static_cast<double>(i) / settings.plate_frequency - kMargin);
    const double angle = motion.at(times.back())->angle;
    angles.push_back(settings.encoder_quantised ? step * std::round(angle / step) : angle);
  }
  return {kEpoch, std::move(times), std::move(angles), 10 / settings.plate_frequency};
}

void append(SimulatedMeasurements& result, const Sweep& sweep, const ScannerSettings& settings) {
  Measurements& to = result.beams;
  const double eta = settings.truth.lasers[sweep.laser].eta.value;
  const double mount = settings.rig.lasers[sweep.laser].mount;
  const FieldOfView field = settings.pattern_of(sweep.laser).field;
  for (std::size_t i = 0; i < sweep.beams.size(); ++i) {
    if (sweep.ranges[i] == 0) {
      ++result.no_echo;
      continue;
    }
    to.range.push_back(sweep.ranges[i]);
    to.mirror_angle.push_back(
        static_cast<float>(data::wrapped_mirror_angle(field.angle_of(sweep.beams[i]) - mount)));
    to.time.push_back(sweep.times[i] - eta);
    to.laser.push_back(sweep.laser);
    to.remission.push_back(sweep.remissions[i]);
    to.beam.push_back(sweep.beams[i]);
    result.surface.push_back(sweep.surfaces[i]);
    result.cos_incidence.push_back(sweep.cos_incidences[i]);
  }
}

}  // namespace

SimulatedMeasurements simulate_measurements(const ScannerSettings& settings, const Scene& scene,
                                            const Motion& motion, const TermRegistry& terms) {
  SweepSimulator sweeps(settings, scene, motion, terms);
  SimulatedMeasurements result{.beams = {},
                               .surface = {},
                               .cos_incidence = {},
                               .plate = read_encoder(settings, motion),
                               .truth = settings.truth};
  result.beams.epoch_ns = kEpoch;
  for (Sweep sweep = sweeps.next(); sweep.revolution.begin < settings.duration; sweep = sweeps.next()) {
    append(result, sweep, settings);
  }
  return result;
}

SimulatedMeasurements simulate_measurements(const ScannerSettings& settings, const Scene& scene,
                                            const TermRegistry& terms) {
  return simulate_measurements(settings, scene,
                               make_motion(settings.motion, settings.duration, settings.seed), terms);
}

}  // namespace crisp::simulate
