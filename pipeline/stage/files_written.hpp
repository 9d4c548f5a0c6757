// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/data/error.hpp"
#include "pipeline/stage/pipeline.hpp"

namespace crisp {

/// Adds an error for each stage that is to write a file that another one reads or has written: the options of
/// paths say which are which. Opens no file.
/// @param read_already  the pipeline's own file and the rig's; empty ones are passed over
void check_files_written(const Pipeline& pipeline, const std::vector<std::filesystem::path>& read_already,
                         std::vector<Error>& errors);

}  // namespace crisp
