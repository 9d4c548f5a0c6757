// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <crisp/option.hpp>
#include <crisp/rig.hpp>

#include "grabbers/simulate/settings.hpp"

namespace crisp::simulate {

/// Understands a map of lasers: `{laser2: {first_angle: -5deg, last_angle: 185deg, step: 0.25deg,
/// mirror_frequency: 25Hz}}`.
///
/// @param otherwise  what holds where nothing is given
/// @return           one for each laser of the rig; none if no laser is named
/// @throws Errors    with every mistake: lasers and keys that are not known (and which is near), values in a
///                   wrong unit, fields of view without beams
std::vector<ScanPattern> read_patterns(const OptionGroups& lasers, const Rig& rig,
                                       const ScanPattern& otherwise);

}  // namespace crisp::simulate
