// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <stdexcept>
#include <string_view>

namespace crisp::files {

/// Why bytes cannot be decompressed, in words.
struct CompressionFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Decompresses a file's bytes piece by piece.
class Decompressor {
 public:
  Decompressor() = default;
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
  virtual ~Decompressor() = default;

  /// One for files that begin so (gzip, zstd); null where they are not compressed.
  static std::unique_ptr<Decompressor> of(std::string_view begin);

  /// Decompresses of `from`, off whose front it takes what it has used, at most `most` bytes.
  /// @return how many; where it is 0, `from` is empty, too
  /// @throws CompressionFault
  virtual std::size_t run(std::string_view& from, char* to, std::size_t most) = 0;
  /// Whether the file may end here: not within a compressed member.
  virtual bool may_end() const = 0;
};

}  // namespace crisp::files
