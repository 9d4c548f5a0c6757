// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "grabbers/wire/bytes.hpp"
#include "grabbers/wire/fields.hpp"

namespace crisp::wire {

/// Reads CoLa-B's fields: big-endian, packed, of fixed width.
class BinaryReader : public FieldReader {
 public:
  static constexpr bool kReads = true;

  explicit BinaryReader(ByteView bytes) : bytes_(bytes) {}

  std::size_t remaining() const { return bytes_.size(); }

  template <std::integral T>
  void number(T& value) {
    if (!has(sizeof(T))) return;
    value = decode<T>(bytes_.data());
    bytes_ = bytes_.subspan(sizeof(T));
  }

  void real(float& value) {
    auto bits = std::bit_cast<std::uint32_t>(value);
    number(bits);
    value = std::bit_cast<float>(bits);
  }

  /// A text of known length.
  void text(std::string& value, std::size_t length) {
    if (!has(length)) return;
    value = as_text(bytes_.first(length));
    bytes_ = bytes_.subspan(length);
  }

  /// `count` numbers, each `width` bytes wide (1 or 2).
  void values(std::vector<std::uint16_t>& out, std::size_t count, std::size_t width) {
    if (!has(count * width)) return;
    out.resize(count);
    const auto* at = bytes_.data();
    if (width == 1) {
      for (std::size_t i = 0; i < count; ++i) out[i] = at[i];
    } else {
      for (std::size_t i = 0; i < count; ++i) out[i] = decode<std::uint16_t>(at + 2 * i);
    }
    bytes_ = bytes_.subspan(count * width);
  }

 private:
  bool has(std::size_t n) {
    if (n > bytes_.size()) fail(FieldFailure::TooShort);
    return ok();
  }

  template <std::integral T>
  static T decode(const std::uint8_t* at) {
    std::make_unsigned_t<T> value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value = static_cast<std::make_unsigned_t<T>>((static_cast<std::uint64_t>(value) << 8) | at[i]);
    }
    return static_cast<T>(value);
  }

  ByteView bytes_;
};

/// Writes CoLa-B's fields to the end of a buffer.
class BinaryWriter {
 public:
  static constexpr bool kReads = false;

  explicit BinaryWriter(Bytes& out) : out_(out) {}

  template <std::integral T>
  void number(T value) {
    const auto bits = static_cast<std::make_unsigned_t<T>>(value);
    for (std::size_t i = sizeof(T); i-- > 0;) out_.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
  }

  void real(float value) { number(std::bit_cast<std::uint32_t>(value)); }

  void text(std::string_view value, std::size_t /*length*/) {
    out_.insert(out_.end(), value.begin(), value.end());
  }

  void values(const std::vector<std::uint16_t>& in, std::size_t count, std::size_t width) {
    for (std::size_t i = 0; i < count; ++i) {
      if (width == 2) out_.push_back(static_cast<std::uint8_t>(in[i] >> 8));
      out_.push_back(static_cast<std::uint8_t>(in[i]));
    }
  }

 private:
  Bytes& out_;
};

}  // namespace crisp::wire
