// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/estimate/search_range.hpp"

namespace crisp {

/// Leaves out of `parameters` those that the motion of the plate cannot tell: directions in which, over all
/// of the range in which they are looked for, the cloud's points move by less than 5 mm apart from rigid
/// motions. So it is with the η of a plate at constant speed, which turns a laser's cloud as its λ does.
///
/// The motion is seen through readings 50 ms apart: between closer ones the encoder's rounding looks like
/// changes of speed, which a million beams would take for information.
///
/// Parameters of terms stay: whether the beams tell them is another question, as what they do is small.
FreeParameters can_be_told(FreeParameters parameters, const SensorModel& model, const Sample& sample,
                           const SearchRange& range);

}  // namespace crisp
