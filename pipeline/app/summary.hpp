// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/app/run_record.hpp"

namespace crisp::app {

/// Text for people at the end of a run: each stage's report, losses and durations.
/// @param verbose  also the effective options, the data flow, and counts that are 0
std::string summary_text(const RunRecord& record, bool verbose);

/// Losses and warnings up to a failure: often the reason.
std::string failure_text(const RunRecord& record);

/// Warnings and caveats only, for --quiet.
std::string warnings_text(const RunRecord& record);

}  // namespace crisp::app
