// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/lock_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/files/json_text.hpp"
#include "pipeline/files/utc_now.hpp"

namespace crisp::files {
namespace {

namespace fs = std::filesystem;
using LockJson = nlohmann::ordered_json;

[[noreturn]] void fail_to_lock(const fs::path& folder, int code) {
  throw Error("cannot write into the folder " + folder.string() + ": " + std::strerror(code),
              is_disk_full(code) ? "make room on the disk" : "");
}

std::string read_all(const fs::path& file) try {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
} catch (const std::ios_base::failure& failure) {
  throw Error("cannot read the lock " + file.string() + ": " + failure.code().message(),
              "check the disk, or give another folder");
}

/// A file that is just being made has no owner yet: whoever makes it may be on any machine.
Liveness liveness_of(const FoundLock& lock) {
  return lock.owner ? liveness_of(lock.owner->process) : Liveness::unknown;
}

bool is_stale(const FoundLock& lock, fs::file_time_type now, std::chrono::milliseconds lease) {
  const Liveness liveness = liveness_of(lock);
  if (liveness != Liveness::unknown) return liveness == Liveness::dead;
  std::error_code gone;
  const auto renewed = fs::last_write_time(lock.path, gone);
  return !gone && now - renewed > lease;
}

void remove_stale(const fs::path& lock) {
  std::error_code failure;
  fs::remove(lock, failure);
  if (failure)
    throw Error(
        "cannot remove " + lock.string() + ", the lock of a process that has ended: " + failure.message(),
        "remove the file");
}

}  // namespace

std::string to_json_text(const LockOwner& owner) {
  // The two states have texts of one length, so that the file can be changed in place.
  const LockJson json = {{"state", owner.holds ? "holds " : "claims"},
                         {"process", owner.process.number},
                         {"host", owner.process.host},
                         {"since", owner.since},
                         {"command", owner.command},
                         {"machine", owner.process.machine},
                         {"start_ticks", owner.process.start}};
  return json_text(json, 2) + "\n";
}

std::optional<LockOwner> parse_lock_owner(const std::string& text) try {
  const LockJson json = LockJson::parse(text);
  LockOwner owner;
  owner.holds = json.at("state").get<std::string>().starts_with("holds");
  owner.process = {json.at("host"), json.at("machine"), json.at("process"), json.at("start_ticks")};
  owner.since = json.at("since");
  owner.command = json.at("command");
  return owner;
} catch (const LockJson::exception&) {
  return std::nullopt;
}

LockFile::LockFile(const fs::path& folder, const std::string& prefix)
    : owner_{this_process(), utc_now(), command_of_this_process()},
      path_(folder / (prefix + "." + unique_name())) {
  at_signal_.emplace(path_.string());
  if (make_with_content(folder)) return;
  descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail_to_lock(folder, errno);
  if (const int code = write(); code != 0) {
    remove();
    fail_to_lock(folder, code);
  }
}

bool LockFile::make_with_content(const fs::path& folder) {
  descriptor_ = open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return false;
  const std::string nameless = fmt::format("/proc/self/fd/{}", descriptor_);
  if (write() == 0 && linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, path_.c_str(), AT_SYMLINK_FOLLOW) == 0)
    return true;
  close(descriptor_);
  return false;
}

LockFile::~LockFile() { remove(); }

void LockFile::remove() const {
  unlink(path_.c_str());
  close(descriptor_);
}

int LockFile::write() const {
  const std::string text = to_json_text(owner_);
  const ssize_t written = pwrite(descriptor_, text.data(), text.size(), 0);
  if (written == static_cast<ssize_t>(text.size())) return 0;
  return written < 0 ? errno : ENOSPC;
}

void LockFile::hold() {
  owner_.holds = true;
  if (const int code = write(); code != 0) fail_to_lock(path_.parent_path(), code);
}

bool LockFile::renew() const {
  const timespec now[] = {{.tv_sec = 0, .tv_nsec = UTIME_NOW}, {.tv_sec = 0, .tv_nsec = UTIME_NOW}};
  struct stat status = {};
  return futimens(descriptor_, now) == 0 && fstat(descriptor_, &status) == 0 && status.st_nlink > 0;
}

fs::file_time_type LockFile::last_renewal() const {
  struct stat status = {};
  fstat(descriptor_, &status);
  const auto since_epoch =
      std::chrono::seconds(status.st_mtim.tv_sec) + std::chrono::nanoseconds(status.st_mtim.tv_nsec);
  return std::chrono::file_clock::from_sys(std::chrono::sys_time<std::chrono::nanoseconds>(since_epoch));
}

std::vector<FoundLock> living_locks(const fs::path& folder, const std::string& prefix, fs::file_time_type now,
                                    std::chrono::milliseconds lease) {
  std::error_code failure;
  std::vector<FoundLock> found;
  fs::directory_iterator entry(folder, failure);
  for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
    const fs::path& path = entry->path();
    if (!path.filename().string().starts_with(prefix + ".")) continue;
    FoundLock lock{path, parse_lock_owner(read_all(path))};
    std::error_code gone;
    if (is_stale(lock, now, lease))
      remove_stale(path);
    else if (fs::exists(path, gone))
      found.push_back(std::move(lock));
  }
  if (failure) fail_to_lock(folder, failure.value());
  std::ranges::sort(found, {}, &FoundLock::path);
  return found;
}

}  // namespace crisp::files
