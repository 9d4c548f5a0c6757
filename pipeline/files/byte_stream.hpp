// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <streambuf>
#include <string_view>
#include <vector>

#include "pipeline/files/decompressor.hpp"

namespace crisp::files {

/// The bytes of a file or a pipe in order, decompressed if the file is compressed by gzip or zstd. A pipe
/// without a writer is waited for, until `interrupted` returns true.
class ByteStream {
 public:
  /// @param interrupted  polled from the reading thread: whether to give up; may be empty
  /// @throws Error if the file cannot be opened, or is a folder
  explicit ByteStream(std::filesystem::path path, std::function<bool()> interrupted = {});
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Reads at least one byte and at most `most`. Returns how many; 0 at the end.
  /// @throws Error        if the disk fails, or compressed bytes are damaged or end early
  /// @throws Interrupted  when `interrupted` returns true
  std::size_t read(void* to, std::size_t most);

  /// Goes on at a place [bytes] of a file that is no pipe. @throws Error if the disk fails
  void move_to(std::uint64_t offset);

  std::uint64_t size() const {
    return size_;
  }  ///< [bytes] of the file when it was opened; 0 for a pipe and where it is
     ///< compressed
  const std::filesystem::path& path() const { return path_; }

 private:
  void wait_for_bytes() const;
  std::size_t read_raw(void* to, std::size_t most);
  std::size_t read_decompressed(char* to, std::size_t most);
  void begin_decompression();

  std::filesystem::path path_;
  std::function<bool()> interrupted_;
  int descriptor_ = -1;
  bool is_file_ = false;
  std::uint64_t size_ = 0;
  std::unique_ptr<Decompressor> decompressor_;  ///< null: it is not compressed
  std::vector<char> compressed_;
  std::string_view left_;       ///< of these
  std::uint64_t position_ = 0;  ///< [bytes] in what is decompressed
};

/// The same as what std::istream reads. Let the stream throw: exceptions(std::ios::badbit).
class ByteStreamBuffer final : public std::streambuf {
 public:
  explicit ByteStreamBuffer(ByteStream& stream) : stream_(stream), buffer_(1 << 16) {}

 protected:
  int_type underflow() override;

 private:
  ByteStream& stream_;
  std::vector<char> buffer_;
};

}  // namespace crisp::files
