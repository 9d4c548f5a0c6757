// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/file_window.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

constexpr std::size_t kRead = 256 * 1024;  // little enough to be in the cache still when it is looked at
constexpr std::size_t kBuffer = FileWindow::kLargestPeek + kRead;

Error cannot_read(const std::filesystem::path& path, int error) {
  return Error(fmt::format("cannot read {}: {}", path.string(), std::strerror(error)),
               "check the name and the permissions");
}

}  // namespace

FileWindow::FileWindow(const std::filesystem::path& path)
    : path_(path),
      descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)),
      buffer_(std::make_unique_for_overwrite<std::uint8_t[]>(kBuffer)) {
  struct stat status {};
  const bool opened = descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0;
  if (!opened || S_ISDIR(status.st_mode)) {
    const int error = opened ? EISDIR : errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw cannot_read(path, error);
  }
  if (S_ISREG(status.st_mode)) size_ = static_cast<std::uint64_t>(status.st_size);
}

FileWindow::~FileWindow() { ::close(descriptor_); }

ByteView FileWindow::peek(std::size_t n) {
  if (end_ - begin_ < n) fill(n);
  return {buffer_.get() + begin_, std::min(n, end_ - begin_)};
}

void FileWindow::skip(std::uint64_t n) {
  while (n > 0) {
    if (begin_ == end_) fill(1);
    if (begin_ == end_) return;
    const auto step = std::min<std::uint64_t>(n, end_ - begin_);
    begin_ += step;
    offset_ += step;
    n -= step;
  }
}

void FileWindow::fill(std::size_t wanted) {
  std::copy(buffer_.get() + begin_, buffer_.get() + end_, buffer_.get());
  end_ -= begin_;
  begin_ = 0;
  while (end_ < wanted) {
    const auto got = ::read(descriptor_, buffer_.get() + end_, std::min(kBuffer - end_, kRead));
    if (got == 0) return;
    if (got < 0 && errno != EINTR) throw cannot_read(path_, errno);
    if (got > 0) end_ += static_cast<std::size_t>(got);
  }
}

}  // namespace crisp
