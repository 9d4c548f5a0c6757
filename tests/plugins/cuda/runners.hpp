// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "plugins/cuda/unit_search.hpp"

namespace crisp::cuda {

/// What computes units in a test.
struct Runner {
  std::string name;
  TakePlan take_plan;
  std::string why_not;  ///< why it cannot be tried here; empty: it can
};

inline void PrintTo(const Runner& runner, std::ostream* out) { *out << runner.name; }

/// The processors for graphics that this build knows.
std::vector<Runner> gpu_runners();

}  // namespace crisp::cuda
