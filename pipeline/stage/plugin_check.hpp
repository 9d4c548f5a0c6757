// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace crisp::stage {

/// Why a file is no valid shared object of this machine, by its kind and its ELF headers: it is a pipe or a
/// device, it is of another machine, it is truncated (by an interrupted copy, for example), or its headers
/// are inconsistent. Empty if it is valid.
///
/// The system's loader does not check: it maps what the headers describe, and the first touch of a page that
/// is not in the file ends the program.
std::string fault_of_object(const std::filesystem::path& file);

/// Runs work in a child process whose output is discarded.
/// @return how the process ended if it crashed or exited: "by signal 11 (Segmentation fault)"; empty if it
/// did not
std::string crash_of(const std::function<void()>& work);

/// Why others may have changed a file: everyone may write to it, or to its folder. Empty
/// otherwise.
std::string exposure_of(const std::filesystem::path& file);

}  // namespace crisp::stage
