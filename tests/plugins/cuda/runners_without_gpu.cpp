// SPDX-License-Identifier: BSD-3-Clause
#include "tests/plugins/cuda/runners.hpp"

namespace crisp::cuda {

std::vector<Runner> gpu_runners() { return {{"Gpu", {}, "built without CRISP_BUILD_CUDA"}}; }

}  // namespace crisp::cuda
