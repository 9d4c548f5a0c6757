// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/cuda/gpu.hpp"
#include "tests/plugins/cuda/runners.hpp"

namespace crisp::cuda {

std::vector<Runner> gpu_runners() { return {{"Gpu", take_plan_to_gpu, why_no_gpu()}}; }

}  // namespace crisp::cuda
