// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/estimator_artifacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace crisp::diagnose {
namespace {

/// [rad] Plate angle at the first beam of each scan of a laser.
std::vector<double> directions(const estimate::Sample& sample, std::size_t laser) {
  std::vector<double> angles;
  int last = -1;
  for (std::size_t i = 0; i < sample.beams.size(); ++i) {
    if (sample.beams.laser[i] != laser) continue;
    const int beam = sample.beams.beam[i];
    const auto state = beam <= last ? sample.plate->at(sample.beams.time[i]) : std::nullopt;
    last = beam;
    if (state) angles.push_back(state->angle);
  }
  return angles;
}

/// Number of evenly spaced directions per turn in which most scans lie; empty without such a pattern.
std::optional<std::size_t> lines_of(std::vector<double> angles) {
  constexpr std::size_t kMax = 3000;  // scans
  constexpr std::size_t kMinLines = 4;
  constexpr double kTogether = 0.7;  // resultant length of the k-th harmonic of the directions
  angles.resize(std::min(angles.size(), kMax));
  const auto n = static_cast<double>(angles.size());
  for (std::size_t lines = kMinLines; lines <= angles.size() / 2; ++lines) {
    std::complex<double> sum = 0;
    for (const double angle : angles) sum += std::polar(1.0, static_cast<double>(lines) * angle);
    if (std::abs(sum) > kTogether * n) return lines;
  }
  return {};
}

}  // namespace

std::optional<EstimatorArtifact> aliasing(const estimate::Sample& sample) {
  constexpr double kTwoTurns = 4 * std::numbers::pi;
  if (sample.beams.size() == 0 || estimate::turned(sample) < kTwoTurns) return {};
  const std::size_t lasers = 1U + std::ranges::max(sample.beams.laser);
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    const auto lines = lines_of(directions(sample, laser));
    if (!lines) continue;
    const double apart = 2 * std::numbers::pi / static_cast<double>(*lines);
    return EstimatorArtifact{
        .name = "aliasing",
        .parameters = {{.name = "lines", .unit = "1", .value = static_cast<double>(*lines)}},
        .reason = fmt::format(
            "the plate was seen in {} directions only, {:.2f} deg apart, since its rate and the mirrors' are commensurate. Effects of the plate angle show in these directions alone, and the RQE optimum shifts. Record at another rate, or with a changing one",
            *lines, apart * 180 / std::numbers::pi)};
  }
  return {};
}

std::optional<EstimatorArtifact> density_bias(const Calibration& start, const estimate::Outcome& plain) {
  constexpr double kClear = 3;  // [standard errors]
  if (!start.provenance.contains("calibration") || start.provenance.contains("refinement")) return {};
  const SensorModel came(start);
  EstimatorArtifact found{
      .name = "density",
      .parameters = {},
      .reason =
          "the RQE optimum shifts with the kernel width and with the sampling density of the surfaces. The values are the bias of calibrate.rqe against the surface-based estimate. Add calibrate.refine after it, which removes the bias"};
  for (std::size_t k = 0; k < plain.free.size(); ++k) {
    const std::string& name = plain.model.names()[plain.free[k]];
    const auto known = std::ranges::find(came.names(), name);
    if (known == came.names().end()) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const double shift = came.values()[known - came.names().begin()] -
                         plain.model.values()[static_cast<Eigen::Index>(plain.free[k])];
    const double error = std::sqrt(plain.covariance(i, i));
    if (std::abs(shift) < kClear * error) continue;
    const char* unit = name.ends_with("tau") ? "m" : name.ends_with("eta") ? "s" : "rad";
    found.parameters.push_back({.name = name, .unit = unit, .value = shift, .std_error = error});
  }
  if (found.parameters.empty()) return {};
  return found;
}

}  // namespace crisp::diagnose
