// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/batch/recording.hpp"

namespace crisp::batch {

/// A file that a recording's results depend on, as it was.
struct InputFile {
  std::string file;         ///< its name: of a folder of captures, one of several
  std::uint64_t bytes = 0;  ///< its size
  std::int64_t mtime = 0;   ///< [ns since the Unix epoch] when it was changed last
  std::string sha256 = {};  ///< of its content; empty: not known

  bool operator==(const InputFile&) const = default;
};

/// The files of a recording by size and time, without their content.
/// @param rig  a file that belongs to this recording alone; empty: there is none
/// @throws Error if one is not there or cannot be read
std::vector<InputFile> input_files(const BatchInput& input, const std::filesystem::path& rig);

/// Whether the names, sizes and times are equal.
bool is_untouched(const std::vector<InputFile>& before, const std::vector<InputFile>& now);

/// For equal names and sizes but different times: whether the content equals that of `before`. Reads the
/// files.
/// @throws Error if one cannot be read
bool has_same_content(const std::vector<InputFile>& before, const std::vector<InputFile>& now,
                      const BatchInput& input, const std::filesystem::path& rig);

}  // namespace crisp::batch
