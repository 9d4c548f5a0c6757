// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/own_process.hpp"

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <thread>

#include "pipeline/batch/slurm_environment.hpp"

namespace crisp::app {

std::filesystem::path own_file() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown);
}

unsigned own_cores() {
  const auto variable = [](const char* name) -> const char* { return std::getenv(name); };
  return batch::cores_of_slurm(variable).value_or(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace crisp::app
