// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/term.hpp>

namespace crisp {

/// Adds the built-in terms.
void register_built_in(TermRegistry& terms);

/// A term's parameters as a calibration has them, all at the values that change nothing.
TermParameters neutral_parameters(const TermInfo& term);

/// Effects of clocks, links, noise or the scene, which are no terms of the chain: the simulator applies them,
/// and a diagnosis may identify them.
const std::vector<EffectInfo>& effects_beyond_the_chain();

/// All effects that have a name: the terms, a plugin's among them, and those beyond the chain; by name.
std::vector<EffectInfo> effect_catalogue(const TermRegistry& terms);

}  // namespace crisp
