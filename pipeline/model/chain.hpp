// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <optional>
#include <span>

#include <crisp/sensor_model.hpp>

#include "pipeline/model/laser_pose.hpp"

namespace crisp {

/// The plate's angle as the chain queries it: a trajectory, or the simulator's true motion.
template <class Plate>
concept PlateMotion = requires(Plate plate, double t) {
  { plate.at(t) } -> std::convertible_to<std::optional<PlateState>>;
};

inline double scalar(double value) { return value; }
inline double scalar(const Jet& value) { return value.a; }

/// Lets the terms of one phase change the beams.
template <class T>
void apply_phase(const LaserChain& chain, Phase phase, std::span<const T> parameters,
                 std::span<Beam<T>> beams) {
  for (const auto& [term, first] : chain.phases[static_cast<std::size_t>(phase)]) {
    term->apply(beams, parameters.subspan(first, term->info().parameters.size()));
  }
}

/// Does nothing after a phase of trace().
struct NothingAfter {
  template <class T>
  void operator()(Phase, std::span<Beam<T>>) const {}
};

/// Applies the whole chain to beams of one laser. Beams at whose time the plate's angle is unknown are marked
/// false in `known` and have no point.
///
/// @param chain       the laser's
/// @param parameters  in the order of chain.slots
/// @param beams       with the measurements filled in; the rest is set here
/// @param plate       φ(t) [rad] on the hub's clock
/// @param after       after(phase, beams) is called at the end of each phase, and may change what that has
/// set
template <class T, PlateMotion Plate, class After = NothingAfter>
[[gnu::flatten]] void trace(const LaserChain& chain, std::span<const T> parameters, std::span<Beam<T>> beams,
                            Plate& plate, std::span<bool> known, const After& after = {}) {
  const auto end = [&](Phase phase) {
    apply_phase(chain, phase, parameters, beams);
    after(phase, beams);
  };
  const Mounting<T> laser{.lambda = parameters[0], .tau = parameters[1], .alpha = parameters[2]};
  const T& eta = parameters[3];

  for (auto& beam : beams) beam.time = beam.hub_time + eta;
  end(Phase::kTime);

  for (std::size_t i = 0; i < beams.size(); ++i) {
    auto& beam = beams[i];
    const double t = scalar(beam.time);
    const auto state = plate.at(t);
    known[i] = state.has_value();
    const PlateState plate_then = state.value_or(PlateState{});
    const T since = beam.time - t;  // zero but for its derivatives
    beam.encoder_angle = plate_then.angle + plate_then.rate * since;
    beam.plate_rate = plate_then.rate + plate_then.acceleration * since;
    beam.plate_angle = beam.encoder_angle;
  }
  end(Phase::kPlate);

  for (auto& beam : beams) beam.mirror_angle = T(beam.measured_mirror);
  end(Phase::kMirror);

  for (auto& beam : beams) aim(beam);
  end(Phase::kBeam);

  for (auto& beam : beams) mount(beam, laser);
  end(Phase::kMount);

  for (auto& beam : beams) spin(beam, T(beam.plate_angle + laser.lambda));
  end(Phase::kBase);

  for (auto& beam : beams) beam.range = T(beam.measured_range);
  end(Phase::kRange);
}

}  // namespace crisp
