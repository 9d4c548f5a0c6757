// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/files/process_identity.hpp"
#include "pipeline/files/signal_cleanup.hpp"

namespace crisp::files {

/// Content of a lock file, for people and for processes.
struct LockOwner {
  ProcessIdentity process;
  std::string since;    ///< ISO 8601, UTC
  std::string command;  ///< the process's command line
  bool holds = false;   ///< it has the lock; otherwise it only claims it, and may have to give way

  bool operator==(const LockOwner&) const = default;
};

std::string to_json_text(const LockOwner& owner);
/// Nothing if the text is none of a lock file's.
std::optional<LockOwner> parse_lock_owner(const std::string& text);

/// A lock file of this process: no other process, past or future, has one of the same name. It is gone when
/// this object is.
class LockFile {
 public:
  /// Creates the file PREFIX.UNIQUE in this folder, which claims the lock.
  /// @throws Error  if that is not possible
  LockFile(const std::filesystem::path& folder, const std::string& prefix);
  ~LockFile();
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

  /// Writes into the file that this process has the lock. @throws Error
  void hold();
  /// Sets the time of the file's last change to now, as a sign of life. Returns false if another process has
  /// removed the file.
  bool renew() const;
  /// When that was, by the clock that dates the folder's files: a file server's may differ from this
  /// machine's.
  std::filesystem::file_time_type last_renewal() const;

  const std::filesystem::path& path() const { return path_; }

 private:
  /// Creates the file with its content at once: a process that is killed meanwhile leaves no file without an
  /// owner, which would count until its lease is over. False where the file system does not support unnamed
  /// files.
  bool make_with_content(const std::filesystem::path& folder);
  int write() const;  ///< returns the system's error number, or 0
  void remove() const;

  LockOwner owner_;
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::optional<SignalCleanup> at_signal_;
};

/// A lock file of another owner.
struct FoundLock {
  std::filesystem::path path;
  std::optional<LockOwner> owner;  ///< nothing while the file is being written
};

/// The lock files PREFIX.* in a folder, by their names, less those whose owner is dead, which are removed.
/// The owner on another machine is taken for dead if its file was not renewed for `lease`.
/// @throws Error  if the folder cannot be read, or a file cannot be removed
std::vector<FoundLock> living_locks(const std::filesystem::path& folder, const std::string& prefix,
                                    std::filesystem::file_time_type now, std::chrono::milliseconds lease);

}  // namespace crisp::files
