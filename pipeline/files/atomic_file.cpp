// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/files/process_identity.hpp"
#include "pipeline/files/signal_cleanup.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPart = ".part";

[[noreturn]] void fail(const fs::path& file, int code) {
  const char* advice = is_disk_full(code) ? "make room on the disk" : "";
  throw Error("cannot write " + file.string() + ": " + std::strerror(code), advice);
}

void make_folder_of(const fs::path& file) {
  std::error_code failure;
  const fs::path folder = file.parent_path();
  if (!folder.empty()) fs::create_directories(folder, failure);
  if (failure) fail(file, failure.value());
}

/// Refuses to replace devices and folders, also where a symbolic link leads to one.
void refuse_no_file(const fs::path& file) {
  std::error_code missing;  // that there is no such file yet is no failure
  const auto status = fs::status(file, missing);
  const bool is_stream =  // /dev/stdout, whatever that is just now
      fs::is_symlink(file, missing) && fs::read_symlink(file, missing).string().starts_with("/proc/");
  if (is_stream || (fs::exists(status) && !fs::is_regular_file(status)))
    throw Error("cannot write " + file.string() + ": it is there and is not a file",
                "give the name of a file");
}

/// A file of a new name next to `file`, whose name shows its purpose.
std::FILE* create_aside(const fs::path& file, fs::path& aside) {
  aside = file.parent_path() / fmt::format(".{}.{}{}", file.filename().string(), files::unique_name(), kPart);
  const int descriptor = open(aside.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(file, errno);
  std::FILE* stream = fdopen(descriptor, "w+b");
  if (stream != nullptr) return stream;
  const int code = errno;
  close(descriptor);
  unlink(aside.c_str());
  fail(file, code);
}

/// Whether a process that is dead left this file, before it was complete.
bool is_left_over(const fs::path& file) {
  const std::string name = file.filename().string();
  if (!name.starts_with('.') || !name.ends_with(kPart)) return false;
  const std::string stem = name.substr(0, name.size() - std::strlen(kPart));
  return files::liveness_of_maker(stem.substr(stem.rfind('.') + 1)) == files::Liveness::dead;
}

/// Makes the renaming durable. Some file systems cannot; that is no reason to fail.
void sync_folder(const fs::path& folder) {
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(fs::path file) : file_(std::move(file)) {
  make_folder_of(file_);
  refuse_no_file(file_);
  stream_.reset(create_aside(file_, aside_));
  at_signal_ = std::make_unique<SignalCleanup>(aside_.string());
}

AtomicFile::~AtomicFile() {
  if (!stream_) return;
  std::error_code ignored;  // nothing can be done about it here
  fs::remove(aside_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) fail(file_, errno);
}

void AtomicFile::rewrite(long offset, std::string_view bytes) {
  if (std::fseek(stream_.get(), offset, SEEK_SET) != 0) fail(file_, errno);
  write(bytes);
  if (std::fseek(stream_.get(), 0, SEEK_END) != 0) fail(file_, errno);
}

void AtomicFile::read(long offset, std::span<char> bytes) {
  if (std::fseek(stream_.get(), offset, SEEK_SET) != 0) fail(file_, errno);
  if (std::fread(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) fail(file_, errno);
  if (std::fseek(stream_.get(), 0, SEEK_END) != 0) fail(file_, errno);
}

void AtomicFile::commit() {
  if (std::fflush(stream_.get()) != 0) fail(file_, errno);
  // A library that wrote to aside() may have replaced the file; what has to last is the one of that name.
  const int descriptor = open(aside_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(file_, errno);
  const int synced = fsync(descriptor);
  const int code = errno;
  close(descriptor);
  if (synced != 0) fail(file_, code);
  remove_record_of(file_);
  if (std::rename(aside_.c_str(), file_.c_str()) != 0) fail(file_, errno);
  at_signal_.reset();
  stream_.reset();
  sync_folder(file_.parent_path());
}

bool is_disk_full(int code) { return code == ENOSPC || code == EDQUOT || code == EFBIG; }

void remove_record_of(const fs::path& file) {
  std::error_code not_there;
  fs::remove(file.string() + kProvenance, not_there);
}

void remove_left_over_parts(const fs::path& folder) {
  std::error_code failure;  // what cannot be removed is in nobody's way
  fs::directory_iterator entry(folder, failure);
  for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
    std::error_code not_removed;
    if (is_left_over(entry->path())) fs::remove(entry->path(), not_removed);
  }
}

void write_file(const fs::path& file, std::string_view bytes) {
  AtomicFile out(file);
  out.write(bytes);
  out.commit();
}

}  // namespace crisp
