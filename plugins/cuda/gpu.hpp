// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "plugins/cuda/unit_search.hpp"

namespace crisp::cuda {

/// Why no graphics processor can be used, in words; empty if one can.
std::string why_no_gpu();

/// TakePlan for the current CUDA device, whose memory holds the plan and the cloud from one call to the next.
/// @throws Error  (as what it returns does) if there is none, if the cloud does not fit its memory, or if it
/// fails
SumUnits take_plan_to_gpu(const CellPlan& plan);

}  // namespace crisp::cuda
