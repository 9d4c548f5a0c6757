// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/byte_stream.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <crisp/error.hpp>

namespace crisp::files {
namespace {

Error cannot_read_bytes(const std::filesystem::path& path, int error) {
  return Error(fmt::format("cannot read {}: {}", path.string(), std::strerror(error)),
               error == EISDIR ? "name a file in it" : "check its name and its permissions");
}

}  // namespace

ByteStream::ByteStream(std::filesystem::path path, std::function<bool()> interrupted)
    : path_(std::move(path)),
      interrupted_(std::move(interrupted)),
      // Opening a pipe without O_NONBLOCK waits for a writer, and cannot be interrupted.
      descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  struct stat status {};
  const bool opened = descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0;
  if (!opened || S_ISDIR(status.st_mode)) {
    const int error = opened ? EISDIR : errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw cannot_read_bytes(path_, error);
  }
  is_file_ = S_ISREG(status.st_mode);
  if (is_file_) size_ = static_cast<std::uint64_t>(status.st_size);
  if (is_file_) begin_decompression();
}

void ByteStream::begin_decompression() {
  std::array<char, 4> begin{};
  const auto got = ::pread(descriptor_, begin.data(), begin.size(), 0);
  decompressor_ = Decompressor::of({begin.data(), got > 0 ? static_cast<std::size_t>(got) : 0});
  if (!decompressor_) return;
  constexpr std::size_t kAtOnce = 1 << 17;
  size_ = position_ = 0;
  compressed_.resize(kAtOnce);
  left_ = {};
}

ByteStream::~ByteStream() { ::close(descriptor_); }

/// Waits on a pipe until there is something to read or all its writers have closed it.
void ByteStream::wait_for_bytes() const {
  constexpr int kPollEvery = 50;  // [ms]
  pollfd source{.fd = descriptor_, .events = POLLIN, .revents = 0};
  do {
    if (interrupted_ && interrupted_()) throw Interrupted();
  } while (!is_file_ && ::poll(&source, 1, kPollEvery) <= 0);
}

std::size_t ByteStream::read(void* to, std::size_t most) {
  return decompressor_ ? read_decompressed(static_cast<char*>(to), most) : read_raw(to, most);
}

std::size_t ByteStream::read_decompressed(char* to, std::size_t most) {
  try {
    while (true) {
      if (const std::size_t made = decompressor_->run(left_, to, most); made > 0) {
        position_ += made;
        return made;
      }
      left_ = {compressed_.data(), read_raw(compressed_.data(), compressed_.size())};
      if (!left_.empty()) continue;
      if (!decompressor_->may_end()) throw CompressionFault("it ends early");
      return 0;
    }
  } catch (const CompressionFault& fault) {
    throw Error(
        fmt::format("{} cannot be decompressed from byte {} on: {}", path_.string(), position_, fault.what()),
        "use an intact copy; gunzip and unzstd recover the data before");
  }
}

std::size_t ByteStream::read_raw(void* to, std::size_t most) {
  while (true) {
    wait_for_bytes();
    const auto got = ::read(descriptor_, to, most);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR && errno != EAGAIN) throw cannot_read_bytes(path_, errno);
  }
}

void ByteStream::move_to(std::uint64_t offset) {
  if (decompressor_) {
    if (offset < position_) {
      if (::lseek(descriptor_, 0, SEEK_SET) < 0) throw cannot_read_bytes(path_, errno);
      begin_decompression();
    }
    std::vector<char> passed(1 << 16);
    while (position_ < offset) {
      if (read_decompressed(passed.data(), std::min<std::uint64_t>(passed.size(), offset - position_)) == 0)
        return;
    }
    return;
  }
  if (::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) throw cannot_read_bytes(path_, errno);
}

ByteStreamBuffer::int_type ByteStreamBuffer::underflow() {
  const std::size_t got = stream_.read(buffer_.data(), buffer_.size());
  if (got == 0) return traits_type::eof();
  setg(buffer_.data(), buffer_.data(), buffer_.data() + got);
  return traits_type::to_int_type(*gptr());
}

}  // namespace crisp::files
