// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/file_window.hpp"

#include <algorithm>
#include <utility>

namespace crisp::capture {
namespace {

constexpr std::size_t kRead = 256 * 1024;  // small enough to be in the cache still when it is parsed
constexpr std::size_t kBuffer = FileWindow::kLargestPeek + kRead;

}  // namespace

FileWindow::FileWindow(const std::filesystem::path& path, std::function<bool()> interrupted)
    : stream_(path, std::move(interrupted)),
      buffer_(std::make_unique_for_overwrite<std::uint8_t[]>(kBuffer)) {}

wire::ByteView FileWindow::peek(std::size_t n) {
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

void FileWindow::move_to(std::uint64_t offset) {
  stream_.move_to(offset);
  offset_ = offset;
  begin_ = end_ = 0;
}

void FileWindow::fill(std::size_t requested) {
  std::copy(buffer_.get() + begin_, buffer_.get() + end_, buffer_.get());
  end_ -= begin_;
  begin_ = 0;
  while (end_ < requested) {
    const std::size_t got = stream_.read(buffer_.get() + end_, std::min(kBuffer - end_, kRead));
    if (got == 0) return;
    end_ += got;
  }
}

}  // namespace crisp::capture
