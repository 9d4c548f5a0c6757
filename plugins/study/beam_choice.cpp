// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/beam_choice.hpp"

#include <algorithm>
#include <cmath>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp::study {
namespace {

constexpr double kRight = 90 * data::kDegree;

/// Indices of the beams of one laser that lie in the plate's plane.
std::vector<std::uint16_t> in_plane_of(const RigLaser& laser, const simulate::FieldOfView& field) {
  std::vector<std::uint16_t> found;
  for (const double theta : {-kRight, kRight}) {
    const double index = std::round((laser.mount + theta - field.first) / field.step);
    if (index >= 0 && index < static_cast<double>(field.beams())) {
      found.push_back(static_cast<std::uint16_t>(index));
    }
  }
  if (found.empty()) {
    throw Error("no beam of " + laser.name + " lies in the plate's plane",
                "let its field of view reach 90 degrees from its mount");
  }
  return found;
}

/// Only the beams that `wanted` lists for their laser.
simulate::SimulatedMeasurements narrowed(const simulate::SimulatedMeasurements& all,
                                         const std::vector<std::vector<std::uint16_t>>& requested) {
  simulate::SimulatedMeasurements result{.beams = {},
                                         .surface = {},
                                         .cos_incidence = {},
                                         .plate = all.plate,
                                         .truth = all.truth,
                                         .no_echo = all.no_echo};
  result.beams.epoch_ns = all.beams.epoch_ns;
  for (std::size_t i = 0; i < all.beams.size(); ++i) {
    const auto& of_laser = requested[all.beams.laser[i]];
    if (std::ranges::find(of_laser, all.beams.beam[i]) == of_laser.end()) continue;
    result.beams.append(all.beams, i);
    result.surface.push_back(all.surface[i]);
    result.cos_incidence.push_back(all.cos_incidence[i]);
  }
  return result;
}

}  // namespace

simulate::SimulatedMeasurements simulate_beams(BeamChoice beams, simulate::ScannerSettings scanner,
                                               const simulate::Scene& scene, const simulate::Motion& motion,
                                               const TermRegistry& terms) {
  if (beams == BeamChoice::kAll) return simulate::simulate_measurements(scanner, scene, motion, terms);
  std::vector<std::vector<std::uint16_t>> requested;
  scanner.beams.clear();
  for (std::size_t i = 0; i < scanner.rig.lasers.size(); ++i) {
    requested.push_back(in_plane_of(scanner.rig.lasers[i], scanner.pattern_of(i).field));
    scanner.beams.insert(scanner.beams.end(), requested.back().begin(), requested.back().end());
  }
  std::ranges::sort(scanner.beams);
  scanner.beams.erase(std::unique(scanner.beams.begin(), scanner.beams.end()), scanner.beams.end());
  // With differently mounted lasers, each fires the others' beams, too.
  return narrowed(simulate::simulate_measurements(scanner, scene, motion, terms), requested);
}

}  // namespace crisp::study
