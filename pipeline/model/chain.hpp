// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <optional>
#include <span>

#include <crisp/sensor_model.hpp>

#include "pipeline/model/laser_pose.hpp"

namespace crisp::model {

/// The plate's angle as the chain queries it: a trajectory, or the simulator's true motion.
template <class Plate>
concept PlateMotion = requires(Plate plate, double t) {
  { plate.at(t) } -> std::convertible_to<std::optional<PlateState>>;
};

inline double scalar(double value) { return value; }
inline double scalar(const Jet& value) { return value.a; }

inline constexpr std::size_t kBaseParameters = 4;  ///< of a chain, its first: λ, τ, α, η

/// Whether the phase's terms correct a reading, each by itself, or move the beam one after the other: see
/// Beam.
inline bool is_reading(Phase phase) {
  return phase != Phase::kBeam && phase != Phase::kMount && phase != Phase::kBase;
}

/// A place in a chain: ahead of a term of a phase, or at the phase's end.
struct ChainPlace {
  Phase phase{};
  std::size_t term = 0;  ///< index among the phase's; their number: at its end
  bool operator==(const ChainPlace&) const = default;
};

/// Does nothing at the places of trace().
struct VisitsNothing {
  template <class T>
  void operator()(ChainPlace, std::span<Beam<T>>) const {}
};

/// Lets the terms of one phase change the beams.
template <class T, class Visit = VisitsNothing>
void apply_phase(const LaserChain& chain, Phase phase, std::span<const T> parameters,
                 std::span<Beam<T>> beams, const Visit& visit = {}) {
  const auto& terms = chain.phases[static_cast<std::size_t>(phase)];
  for (std::size_t k = 0; k < terms.size(); ++k) {
    visit(ChainPlace{phase, k}, beams);
    terms[k].term->apply(beams,
                         parameters.subspan(terms[k].first_slot, terms[k].term->info().parameters.size()));
  }
  visit(ChainPlace{phase, terms.size()}, beams);
}

/// Applies the whole chain to beams of one laser. Beams at whose time the plate's angle is unknown are marked
/// false in `known` and have no point.
///
/// @param chain       the laser's
/// @param parameters  in the order of chain.slots
/// @param beams       with the measurements filled in; the rest is set here
/// @param plate       φ(t) [rad] on the hub's clock
/// @param visit       visit(place, beams) is called at each place, and may change what the phase has set
template <class T, PlateMotion Plate, class Visit = VisitsNothing>
[[gnu::flatten]] void trace(const LaserChain& chain, std::span<const T> parameters, std::span<Beam<T>> beams,
                            Plate& plate, std::span<bool> known, const Visit& visit = {}) {
  const auto end = [&](Phase phase) { apply_phase(chain, phase, parameters, beams, visit); };
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
    beam.plate_direction = plate_then.direction + plate_then.direction_rate * since;
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

}  // namespace crisp::model
