// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace crisp::files {

class LockFile;

struct FolderLockSettings {
  std::chrono::milliseconds heartbeat{5'000};  ///< how often the owner renews its lock
  std::chrono::milliseconds plate_timeout{
      20'000};  ///< with claimants that neither take the lock nor give way
  /// Without renewal for so long, the lock of a process on another machine is taken over.
  std::chrono::milliseconds lease{60'000};
};

/// Keeps other processes from writing into the same folder while it lives. The lock is a file in the folder,
/// .crisp-lock.UNIQUE, that names process, machine, command and since when.
///
/// It needs no more of the file system than that a file is made under a new name, and listed at once: it
/// works on file servers, too. Each claimant makes a file of its own and then lists those of the others; it
/// has the lock only if there is none whose owner lives. Files of owners that are dead (on this machine), or
/// gave no sign of life for the lease (on another), are removed. Two claimants cannot both see no other, and
/// no name comes twice, so that what one of them removes is never the file of one that lives.
class FolderLock {
 public:
  /// Creates the folder if necessary.
  /// @throws Error  if another process has the lock, which is then named, or if no lock can be made there
  explicit FolderLock(const std::filesystem::path& folder, const FolderLockSettings& settings = {});
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Whether another process has taken the lock over, because this one gave no sign of life for the lease (it
  /// was stopped, or its file server could not be reached).
  bool is_lost() const { return lost_; }

  /// Whether a message is that by which the constructor refuses a folder that is in use.
  static bool is_refusal(std::string_view message);

  /// The process that has a folder's lock, in words: "process 12 on host"; nothing if none has, or the folder
  /// is not there. Removes the locks of the dead.
  static std::optional<std::string> holder_of(const std::filesystem::path& folder,
                                              const FolderLockSettings& settings = {});

 private:
  std::unique_ptr<LockFile> file_;
  std::atomic<bool> lost_ = false;
  std::jthread heartbeat_;
};

}  // namespace crisp::files
