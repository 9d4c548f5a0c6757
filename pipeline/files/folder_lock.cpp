// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/folder_lock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <vector>

#include <crisp/error.hpp>

#include "pipeline/files/lock_file.hpp"

namespace crisp::files {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInUse = " is in use: ";
constexpr const char* kLockPrefix = ".crisp-lock";
constexpr auto kListAgain = std::chrono::milliseconds(10);

Error refusal_by(const fs::path& folder, const FoundLock& lock, std::chrono::milliseconds lease) {
  const std::string who = lock.owner ? fmt::format("process {} on {} has been writing into it since {} ({})",
                                                   lock.owner->process.number, lock.owner->process.host,
                                                   lock.owner->since, lock.owner->command)
                                     : "another process is about to lock it";
  const bool is_elsewhere = !lock.owner || liveness_of(lock.owner->process) == Liveness::unknown;
  return Error(
      "the folder " + folder.string() + kInUse + who,
      is_elsewhere
          ? fmt::format(
                "wait for its end, or give another folder; if it was killed, its lock {} expires {} s after its last heartbeat",
                lock.path.filename().string(), lease.count() / 1000)
          : "wait for its end, or give another folder");
}

const fs::path& made(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    throw Error("cannot write into the folder " + folder.string() + ": " + failure.message(),
                "give another folder, or correct its permissions");
  return folder;
}

/// The way of one process to the lock.
class Claimant {
 public:
  Claimant(const fs::path& folder, const FolderLockSettings& settings)
      : folder_(folder), settings_(settings) {}

  std::unique_ptr<LockFile> take() {
    const auto give_up = std::chrono::steady_clock::now() + settings_.plate_timeout;
    for (;; std::this_thread::sleep_for(kListAgain)) {
      const auto others = others_after_claim();
      if (others.empty()) {
        file_->hold();
        if (file_->renew()) return std::move(file_);
      }
      if (others.empty()) continue;
      const auto holder =
          std::ranges::find_if(others, [](const FoundLock& lock) { return lock.owner && lock.owner->holds; });
      if (holder != others.end()) throw refusal_by(folder_, *holder, settings_.lease);
      if (std::chrono::steady_clock::now() > give_up)
        throw refusal_by(folder_, others.front(), settings_.lease);
      // Among those that only claim, the first by name stays: without it none would see no other.
      if (others.front().path < file_->path()) wait_without_claim(others.front().path);
    }
  }

 private:
  std::vector<FoundLock> others_after_claim() {
    if (!file_ || !file_->renew()) file_ = std::make_unique<LockFile>(folder_, kLockPrefix);
    auto locks = living_locks(folder_, kLockPrefix, file_->last_renewal(), settings_.lease);
    std::erase_if(locks, [&](const FoundLock& lock) { return lock.path == file_->path(); });
    return locks;
  }

  void wait_without_claim(const fs::path& first) {
    file_.reset();
    constexpr int kTurns = 20;
    std::error_code gone;
    for (int i = 0; i < kTurns && fs::exists(first, gone); ++i) std::this_thread::sleep_for(kListAgain);
  }

  const fs::path& folder_;
  const FolderLockSettings& settings_;
  std::unique_ptr<LockFile> file_;
};

}  // namespace

FolderLock::FolderLock(const fs::path& folder, const FolderLockSettings& settings)
    : file_(Claimant(made(folder), settings).take()),
      heartbeat_([this, settings](const std::stop_token& over) {
        std::mutex mutex;
        std::condition_variable_any pause;
        std::unique_lock lock(mutex);
        while (!over.stop_requested()) {
          if (!file_->renew()) lost_ = true;
          pause.wait_for(lock, over, settings.heartbeat, [] { return false; });
        }
      }) {}

FolderLock::~FolderLock() = default;

bool FolderLock::is_refusal(std::string_view message) {
  return message.find(kInUse) != std::string_view::npos;
}

std::optional<std::string> FolderLock::holder_of(const fs::path& folder, const FolderLockSettings& settings) {
  std::error_code none;
  if (!fs::is_directory(folder, none)) return std::nullopt;
  for (const auto& lock :
       living_locks(folder, kLockPrefix, fs::file_time_type::clock::now(), settings.lease)) {
    if (lock.owner && lock.owner->holds)
      return fmt::format("process {} on {}", lock.owner->process.number, lock.owner->process.host);
  }
  return std::nullopt;
}

}  // namespace crisp::files
