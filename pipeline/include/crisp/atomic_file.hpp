// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace crisp {

class SignalCleanup;

/// Suffix of a written file's provenance record.
inline constexpr const char* kProvenance = ".provenance.json";

/// Removes that record, before its file changes: afterwards it would be another file's.
void remove_record_of(const std::filesystem::path& file);

/// Whether an error number of the system means that a disk, a quota or a file has no more room.
bool is_disk_full(int code);

/// A file that is there whole or not at all: it is written aside, in the same folder, and takes its name when
/// it is complete and on the disk. Left without commit() (an exception, an interruption), nothing remains of
/// it, and a file of that name from before stays as it was. A symbolic link of that name is replaced, and the
/// file that it leads to stays as it is. The record of the origin of the file that is replaced is removed
/// just before: it never stands next to the new file, though the program be killed.
///
/// Write through write(), or let a library write to aside() and then commit().
class AtomicFile {
 public:
  /// Creates the folder if necessary, and the file aside.
  /// @throws Error that names the file: no permission, not a regular file, a full disk
  explicit AtomicFile(std::filesystem::path file);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// @throws Error that names the file, if the disk is full or fails
  void write(std::string_view bytes);

  /// Replaces bytes that were written: a header whose counts are known at the end. Goes on behind the end.
  /// @param offset  [bytes] from the file's begin; the bytes must end before what was written ends
  /// @throws Error that names the file, if the disk is full or fails
  void rewrite(long offset, std::string_view bytes);

  /// Reads bytes that were written, all of them. Writing goes on behind the end.
  /// @param offset  [bytes] from the file's begin
  /// @throws Error that names the file, if the disk fails
  void read(long offset, std::span<char> bytes);

  /// Puts the file in its place. Nothing may be written afterwards.
  /// @throws Error that names the file, if the disk is full or fails
  void commit();

  const std::filesystem::path& path() const { return file_; }    ///< the file's name once it is complete
  const std::filesystem::path& aside() const { return aside_; }  ///< the file that is written until then

 private:
  struct Close {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };

  std::filesystem::path file_;
  std::filesystem::path aside_;
  std::unique_ptr<SignalCleanup> at_signal_;
  std::unique_ptr<std::FILE, Close> stream_;
};

/// Removes from a folder what AtomicFiles of processes on this machine left that were killed.
void remove_left_over_parts(const std::filesystem::path& folder);

/// Writes a whole file at once, as AtomicFile does.
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace crisp
