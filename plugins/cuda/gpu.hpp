// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "plugins/cuda/unit_search.hpp"

namespace crisp::cuda {

/// Why no graphics processor can be used, in words; empty if one can.
std::string why_no_gpu();

/// SumUnits on the current CUDA device.
/// @throws Error  if there is none, if the cloud does not fit its memory, or if it fails
UnitSums sum_on_gpu(const CellPlan& plan, const Slots& slots, const PairKernel& kernel, bool gradient);

}  // namespace crisp::cuda
