// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/data/likeness.hpp"
#include "plugins/scans/passes.hpp"

namespace crisp {

/// Whether two passes can be told from simulated ones, whose actuator is where it says on both ways: the
/// shift between them in all, and in each quarter of the angles and of the beams, by its error (F, since that
/// is known from the few blocks that it was told by). With a shift that was found, what is left of it on the
/// parts of the angles that it was not fitted to, and whether it is the same in all quarters (about their
/// mean, a freedom less). Amplitudes are by how much either way is off, half of what shifts them.
///
/// @param taken_out  whether the shift was found to be there
ToldApart told_in_passes(const PassShift& shift, bool taken_out);

}  // namespace crisp
