// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int code) {
  const char* advice = code == ENOSPC || code == EDQUOT || code == EFBIG ? "make room on the disk" : "";
  throw Error("cannot write " + file.string() + ": " + std::strerror(code), advice);
}

void make_folder_of(const fs::path& file) {
  std::error_code failure;
  const fs::path folder = file.parent_path();
  if (!folder.empty()) fs::create_directories(folder, failure);
  if (failure) fail(file, failure.value());
}

/// The file behind symbolic links, so that these stay links; refuses to replace devices and folders.
fs::path final_target(const fs::path& file) {
  std::error_code missing;  // that there is no such file yet is no failure
  fs::path target = fs::is_symlink(file, missing) ? fs::weakly_canonical(file) : file;
  const auto status = fs::status(target, missing);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error("cannot write " + file.string() + ": it is there and is not a file");
  }
  return target;
}

/// A file of a new name beside `target`, which tells a person what it was to become.
std::FILE* create_aside(const fs::path& file, const fs::path& target, fs::path& aside) {
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    aside = target.parent_path() / fmt::format(".{}.{}-{}.part", target.filename().string(), getpid(), i);
    const int descriptor = open(aside.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) return fdopen(descriptor, "w+b");
    if (errno != EEXIST) fail(file, errno);
  }
  fail(file, EEXIST);
}

/// Makes the renaming itself last. Some file systems cannot; that is no reason to fail.
void sync_folder(const fs::path& folder) {
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(fs::path file) : file_(std::move(file)) {
  make_folder_of(file_);
  target_ = final_target(file_);
  stream_.reset(create_aside(file_, target_, aside_));
  at_signal_.emplace(aside_.string());
}

AtomicFile::~AtomicFile() {
  if (!stream_) return;
  std::error_code ignored;  // nothing can be done about it here
  fs::remove(aside_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) fail(file_, errno);
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
  if (std::rename(aside_.c_str(), target_.c_str()) != 0) fail(file_, errno);
  at_signal_.reset();
  stream_.reset();
  sync_folder(target_.parent_path());
}

void write_file(const fs::path& file, std::string_view bytes) {
  AtomicFile out(file);
  out.write(bytes);
  out.commit();
}

}  // namespace crisp
