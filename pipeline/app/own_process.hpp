// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace crisp::app {

/// The file of this program; empty where the system does not name it.
std::filesystem::path own_file();

/// Number of cores for this process: those that Slurm allocated to it, or those of the machine.
unsigned own_cores();

}  // namespace crisp::app
