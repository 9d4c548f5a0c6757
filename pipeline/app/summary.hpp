// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/app/run_record.hpp"

namespace crisp {

/// What people read at the end of a run: what each stage had to say, what was lost, how long it took.
/// @param verbose  also the effective options, what flowed, and counts that are 0
std::string summary_text(const RunRecord& record, bool verbose);

/// What had been lost and warned of when a run failed: often the reason.
std::string failure_text(const RunRecord& record);

/// Warnings and doubts only, for those who asked for quiet.
std::string warnings_text(const RunRecord& record);

}  // namespace crisp
