// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "plugins/diagnose/scans/passes.hpp"

namespace crisp::diagnose {

/// Goodness-of-fit test of two passes against the model of an actuator without hysteresis. It tests the shift
/// between the passes in total, and in each quarter of the angles and of the beams (F test, since errors come
/// from few blocks). With a shift removed, it tests the residual shift on angles that the estimate did not
/// use, and the homogeneity of the quarters (one degree of freedom less). Amplitudes are errors of either
/// direction, half the shift between them.
///
/// @param is_removed  whether the shift was accepted and removed
data::GoodnessOfFit pass_fit_test(const PassOffset& shift, bool is_removed);

}  // namespace crisp::diagnose
