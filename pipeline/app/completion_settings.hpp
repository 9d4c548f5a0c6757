// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <crisp/registrar.hpp>

namespace crisp::app {

/// What can stand behind --set: "duration=", "grabber.simulate.motion.kind=constant" for each choice that an
/// option has.
/// @param pipeline  whose stages are meant, by their tags, and its variables; empty, or one that cannot be
/// read:
///                  every stage
std::vector<std::string> settings_to_complete(const std::filesystem::path& pipeline,
                                              const StageRegistry& stages);

/// The values that an option of a stage can have, if these can be listed.
std::vector<std::string> values_to_complete(const Option& option);

}  // namespace crisp::app
