// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "grabbers/wire/bytes.hpp"
#include "grabbers/wire/fields.hpp"

namespace crisp::wire {

/// Reads CoLa-A's fields: tokens between single spaces; a number is upper-case hexadecimal, or decimal when
/// it carries a sign.
class TextReader : public FieldReader {
 public:
  static constexpr bool kReads = true;

  explicit TextReader(std::string_view text);

  /// Characters not read yet; a separator before them does not count.
  std::size_t remaining() const { return text_.size(); }

  template <std::integral T>
  void number(T& value) {
    using Unsigned = std::make_unsigned_t<T>;
    const auto found = token();
    if (!found.empty() && (found.front() == '+' || found.front() == '-')) {
      const auto read = decimal(found, std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
      if (ok()) value = static_cast<T>(read);
    } else {
      const auto read = hexadecimal(found, std::numeric_limits<Unsigned>::max());
      if (ok()) value = static_cast<T>(static_cast<Unsigned>(read));
    }
  }

  void real(float& value) {
    auto bits = std::bit_cast<std::uint32_t>(value);
    number(bits);
    value = std::bit_cast<float>(bits);
  }

  /// A text of known length, which may hold spaces.
  void text(std::string& value, std::size_t length);

  /// `count` numbers that must fit in `width` bytes (1 or 2).
  void values(std::vector<std::uint16_t>& out, std::size_t count, std::size_t width);

  /// Number of remaining tokens.
  std::size_t count_tokens();

 private:
  std::string_view token();
  std::uint32_t hexadecimal(std::string_view token, std::uint32_t largest);
  std::int64_t decimal(std::string_view token, std::int64_t smallest, std::int64_t largest);

  std::string_view text_;
};

/// Writes CoLa-A's fields to the end of a buffer, each after a space.
class TextWriter {
 public:
  static constexpr bool kReads = false;

  explicit TextWriter(Bytes& out) : out_(out) {}

  template <std::integral T>
  void number(T value) {
    hexadecimal(static_cast<std::make_unsigned_t<T>>(value), 1);
  }

  void real(float value) { hexadecimal(std::bit_cast<std::uint32_t>(value), 8); }
  void text(std::string_view value, std::size_t length);
  void values(const std::vector<std::uint16_t>& in, std::size_t count, std::size_t width);

 private:
  void hexadecimal(std::uint32_t value, int digits);

  Bytes& out_;
};

}  // namespace crisp::wire
