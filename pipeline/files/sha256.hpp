// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace crisp::files {

/// A file as provenance names it.
struct FileDigest {
  std::uint64_t bytes = 0;
  std::string sha256;  ///< 64 hexadecimal digits
};

/// @throws Error if the file cannot be read to its end
FileDigest digest_of(const std::filesystem::path& file);

/// SHA-256 of a text, 64 hexadecimal digits.
std::string sha256_of(std::string_view text);

}  // namespace crisp::files
