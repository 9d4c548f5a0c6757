// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "grabbers/wire/bytes.hpp"

namespace crisp {

/// A folder of its own that is gone when the test is.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// A file that is in memory only: thousands of them cost no disk.
class MemoryFile {
 public:
  explicit MemoryFile(wire::ByteView bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const;

 private:
  int descriptor_;
};

wire::Bytes read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, wire::ByteView bytes);

}  // namespace crisp
