// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "grabbers/simulate/scene.hpp"

namespace crisp::simulate {

/// Names of the scenes that need no file: those of configs/scenes, as they were when crisp was built.
const std::vector<std::string>& built_in_scenes();

/// One of them: office, hall, street, workshop (cluttered, round things), garden (mostly foliage) or people
/// (who walk). @throws Error for another name
Scene built_in_scene(const std::string& name);

/// An office of 10 × 8 × 3 m with desks, cupboards and doors; closed.
Scene office();

/// A hall of 30 × 20 × 8 m with pillars, crates and a gallery; closed.
Scene hall();

/// A street of 120 m between house fronts, with kerbs, poles and parked vans; open above and at its ends.
Scene street();

}  // namespace crisp::simulate
