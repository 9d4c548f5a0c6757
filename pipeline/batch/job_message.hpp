// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/batch/launcher.hpp"

namespace crisp::batch {

/// Longest message between a batch and its launcher [bytes].
inline constexpr std::size_t kLongestJobMessage = 64 * 1024;

/// The fields of a message as one text, and back. A field may hold any byte but 0, as paths do.
std::string join_fields(const std::vector<std::string>& fields);
std::vector<std::string> split_fields(const std::string& message);

std::string to_message(const Job& job);
Job job_of(const std::vector<std::string>& fields);

std::string to_message(const JobEnd& end);
JobEnd job_end_of(const std::vector<std::string>& fields);

}  // namespace crisp::batch
