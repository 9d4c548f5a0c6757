// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <crisp/effect_catalogue.hpp>
#include <crisp/option.hpp>
#include <crisp/rig.hpp>

namespace crisp::simulate {

/// A requested effect of the catalogue.
struct Effect {
  std::string name;                  ///< "mirror.cone"
  std::optional<std::size_t> owner;  ///< index of the only laser that has it, or the number of lasers for the
                                     ///< plate; nothing: all that can have it
  std::vector<std::pair<std::string, double>> values;  ///< of the parameters that were given, in SI
  Place place;                                         ///< where it was requested
  bool measured = false;                               ///< on a real device: it replaces what would be drawn
};

/// Understands a map of effects: `{encoder.eccentricity: {a: 0.1deg}, laser2.mirror.cone: {kappa: 0.3deg}}`.
/// An owner in front makes it the effect of one laser, or of the plate.
///
/// @param catalogue  what there is
/// @throws Errors    with every mistake: names that are not known (and which is near), owners that cannot
/// have
///                   the effect, values in a wrong unit or beyond the bounds
std::vector<Effect> read_effects(const OptionGroups& requested, const Rig& rig,
                                 const std::vector<EffectInfo>& catalogue);

}  // namespace crisp::simulate
