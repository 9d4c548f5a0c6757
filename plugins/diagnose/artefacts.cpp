// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/artefacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace crisp {
namespace {

/// [rad] The plate's angle at the first beam of each of a laser's scans.
std::vector<double> directions(const Sample& sample, std::size_t laser) {
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

/// Into how many evenly spaced directions a turn is divided by them, where most lie at these alone.
std::optional<std::size_t> lines_of(std::vector<double> angles) {
  constexpr std::size_t kMost = 3000;  // scans
  constexpr std::size_t kLeastLines = 4;
  constexpr double kTogether = 0.7;  // length of the mean of the directions' k-th harmonics
  angles.resize(std::min(angles.size(), kMost));
  const auto n = static_cast<double>(angles.size());
  for (std::size_t lines = kLeastLines; lines <= angles.size() / 2; ++lines) {
    std::complex<double> sum = 0;
    for (const double angle : angles) sum += std::polar(1.0, static_cast<double>(lines) * angle);
    if (std::abs(sum) > kTogether * n) return lines;
  }
  return {};
}

}  // namespace

std::optional<Artefact> aliasing(const Sample& sample) {
  constexpr double kTwoTurns = 4 * std::numbers::pi;
  if (sample.beams.size() == 0 || turned(sample) < kTwoTurns) return {};
  const std::size_t lasers = 1U + std::ranges::max(sample.beams.laser);
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    const auto lines = lines_of(directions(sample, laser));
    if (!lines) continue;
    const double apart = 2 * std::numbers::pi / static_cast<double>(*lines);
    return Artefact{
        .name = "aliasing",
        .parameters = {{.name = "lines", .unit = "1", .value = static_cast<double>(*lines)}},
        .reason = fmt::format(
            "the plate was seen in {} directions, {:.2f} deg apart, again and again, as its rate and "
            "the mirrors' are commensurate: what goes by its angle shows at these alone, and an "
            "entropy's optimum shifts. Record at another rate, or with a changing one",
            *lines, apart * 180 / std::numbers::pi)};
  }
  return {};
}

std::optional<Artefact> density_bias(const Calibration& start, const Outcome& plain) {
  constexpr double kClear = 3;  // [standard errors]
  if (!start.provenance.contains("calibration") || start.provenance.contains("refinement")) return {};
  const SensorModel came(start);
  Artefact found{
      .name = "density",
      .parameters = {},
      .reason =
          "the optimum of an entropy shifts with the kernel's width and with how densely surfaces are "
          "sampled: by so much calibrate.rqe is off what the surfaces say (calibrate.refine below it takes "
          "that away)"};
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

}  // namespace crisp
