// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/stage/registry.hpp"

namespace crisp {

/// That there is no such stage, what could have been meant, and how a plugin's are known.
Error no_such_stage(const std::string& name, const StageRegistry& stages);

/// What an unknown option could have been meant to be, and where the known ones are listed.
std::string no_such_option(const StageType& type, const std::string& name);

}  // namespace crisp
