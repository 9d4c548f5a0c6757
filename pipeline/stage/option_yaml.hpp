// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <crisp/option.hpp>

#include "pipeline/files/yaml.hpp"

namespace crisp::stage {

/// Reads the value of an option, units converted, paths made absolute.
/// @param who     the stage's tag, the subject of messages
/// @param folder  what relative paths are relative to
/// @return nothing if the value is invalid; `errors` then holds the error with its place
std::optional<OptionValue> read_option(const Option& option, const files::YamlNode& node,
                                       const std::string& who, const std::filesystem::path& folder,
                                       std::vector<Error>& errors);

}  // namespace crisp::stage
