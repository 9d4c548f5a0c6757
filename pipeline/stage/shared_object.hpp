// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace crisp {

/// Why a file is no sound shared object of this machine, by its kind and its ELF headers: it is a pipe or a
/// device, it is of another machine, it was cut short (by a copy that was broken off, say), what its headers
/// describe does not fit together. Empty if nothing is found.
///
/// The system's loader does not look: it maps what the headers describe, and the first touch of a page that
/// is not in the file ends the program.
std::string fault_of_object(const std::filesystem::path& file);

/// Does something in a process of its own, which nothing it says comes out of.
/// @return how that ended if it crashed, or ended the process: "by signal 11 (Segmentation fault)"; empty if
/// it did not
std::string crash_of(const std::function<void()>& work);

/// What makes a file one that others may have changed: that everyone may write to it, or to its folder. Empty
/// if nothing does.
std::string exposure_of(const std::filesystem::path& file);

}  // namespace crisp
