// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/simulate/scene.hpp"

namespace crisp {

/// An office of 10 × 8 × 3 m with desks, cupboards and doors; closed.
Scene office();

/// A hall of 30 × 20 × 8 m with pillars, crates and a gallery; closed.
Scene hall();

/// A street of 120 m between house fronts, with kerbs, poles and parked vans; open above and at its ends.
Scene street();

}  // namespace crisp
