// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/data/measurements.hpp"

namespace crisp {

/// For each beam the piece of the recording that it is of, from 0. Pieces share no error: what is left of the
/// encoder's steps is gone after a tenth of a second; and they are many enough (a hundred, at least) to see
/// by how much their pulls scatter. Nothing is a piece in which no beam was fired. See
/// NormalEquations::pulls.
std::vector<std::uint32_t> recording_blocks(const Measurements& beams);

}  // namespace crisp
