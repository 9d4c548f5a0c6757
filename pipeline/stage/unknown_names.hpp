// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <crisp/pipeline.hpp>
#include <crisp/registrar.hpp>

#include "pipeline/files/renamed_names.hpp"

namespace crisp::stage {

/// The error for an unknown stage, with the nearest names, and how to load a plugin's stages.
Error no_such_stage(const std::string& name, const StageRegistry& stages);

/// Error for an unknown option, with the nearest name and the place of the list.
std::string no_such_option(const StageType& type, const std::string& name);

/// Today's name of a stage or an option. A name of an earlier release adds a warning at its place.
std::string accept_old_name(files::RenamedName::Kind kind, std::string_view owner, const std::string& name,
                            const Place& place, std::vector<PipelineWarning>& warnings);

}  // namespace crisp::stage
