// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/independent/draws.hpp"
#include "tests/independent/population.hpp"

namespace independent {

/// Draws at most one fault of the rig file or the set-up, and injects it: one rig in five has one.
///
/// mount, direction and counts make the rig file wrong, swapped exchanges two addresses in the rig file,
/// missing silences a laser, slip makes the encoder jump.
/// @throws std::runtime_error  if the fault is fixed, but the rig cannot have it
void draw_fault(Draws& draws, Setup& setup);

}  // namespace independent
