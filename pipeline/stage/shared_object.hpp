// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace crisp {

/// What is missing of a shared object that was cut short, by a copy that was broken off say; empty if it is
/// whole, or no ELF file of this machine at all.
///
/// The system's loader does not look: it maps what the headers describe, and the first touch of a page that
/// is not in the file ends the program.
std::string what_is_cut_off(const std::filesystem::path& file);

}  // namespace crisp
