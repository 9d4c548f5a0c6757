// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/stage/registry.hpp"

namespace crisp {

/// The error for an unknown stage, with the nearest names, and how to load a plugin's stages.
Error no_such_stage(const std::string& name, const StageRegistry& stages);

/// Error for an unknown option, with the nearest name and the place of the list.
std::string no_such_option(const StageType& type, const std::string& name);

}  // namespace crisp
