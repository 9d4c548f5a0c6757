// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "grabbers/simulate/scene.hpp"
#include "grabbers/simulate/settings.hpp"

namespace crisp::simulate {

/// The room of the Monte Carlo of Sheehan, Harrison and Newman, section 5.2, as far as it is described: two
/// dimensions, so upright walls only; some 9 × 7 m with a bay, so that it differs from every side.
Scene paper_room();

/// Their scanner: σ = 12 mm, τ = 0.20 m, α = 0, of each laser only the two beams in the plate's plane
/// (reported at −45° and 135°), the plate's rate between 0 and 2 Hz for ten seconds: about ten revolutions.
ScannerSettings paper_scanner(std::uint64_t seed);

}  // namespace crisp::simulate
