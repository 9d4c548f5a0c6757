// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include <crisp/atomic_file.hpp>

namespace crisp::write {

static_assert(std::endian::native == std::endian::little, "PLY and LAS files are written little-endian");

/// Numbers one after the other without padding, as a binary file has them.
class RecordBuffer {
 public:
  /// @param most  [bytes] that are put() before the next flush()
  explicit RecordBuffer(std::size_t most) : bytes_(most, '\0') {}

  template <class T>
  void put(T value) {
    std::memcpy(bytes_.data() + size_, &value, sizeof(T));
    size_ += sizeof(T);
  }
  /// A text in a field of fixed width, filled with zeros.
  void put_text(std::string_view text, std::size_t width) {
    std::memset(bytes_.data() + size_, 0, width);
    std::copy_n(text.begin(), std::min(text.size(), width), bytes_.data() + size_);
    size_ += width;
  }
  void put_zeros(std::size_t n) { put_text({}, n); }

  std::size_t size() const { return size_; }
  std::string_view view() const { return {bytes_.data(), size_}; }
  void flush(AtomicFile& to) {
    to.write(view());
    size_ = 0;
  }

 private:
  std::string bytes_;
  std::size_t size_ = 0;
};

}  // namespace crisp::write
