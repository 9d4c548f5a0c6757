// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "grabbers/wire/bytes.hpp"
#include "pipeline/files/byte_stream.hpp"

namespace crisp::capture {

/// A file (or pipe) read from front to back through a window of constant size.
class FileWindow {
 public:
  static constexpr std::size_t kLargestPeek = 1 << 20;

  /// @param interrupted  as ByteStream's
  /// @throws Error if the file cannot be opened
  explicit FileWindow(const std::filesystem::path& path, std::function<bool()> interrupted = {});

  /// The next n bytes without moving on; fewer at the end of the file. Valid until the next peek().
  /// @param n at most kLargestPeek
  /// @throws Error if the disk fails
  /// @throws Interrupted  when `interrupted` returns true
  wire::ByteView peek(std::size_t n);

  /// Moves on by n bytes, or to the end. What peek() gave stays valid if n does not lead beyond it.
  void skip(std::uint64_t n);

  /// Goes on at a place [bytes] of a file that is no pipe. @throws Error if the disk fails
  void move_to(std::uint64_t offset);

  std::uint64_t offset() const { return offset_; }  ///< [bytes] from the file's begin
  std::uint64_t size() const {
    return stream_.size();
  }  ///< [bytes] of the file when it was opened; 0 for a pipe
  const std::filesystem::path& path() const { return stream_.path(); }

 private:
  void fill(std::size_t requested);

  files::ByteStream stream_;
  std::uint64_t offset_ = 0;
  std::unique_ptr<std::uint8_t[]> buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< of what was read and not passed, in the buffer
};

}  // namespace crisp::capture
