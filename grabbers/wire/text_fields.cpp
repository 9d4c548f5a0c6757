// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/text_fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace crisp::wire {
namespace {

// −1 for a character that is no digit; a table, because a scan has thousands of digits.
constexpr auto kDigits = [] {
  std::array<std::int8_t, 256> table{};
  table.fill(-1);
  for (std::uint8_t i = 0; i < 10; ++i) table['0' + i] = static_cast<std::int8_t>(i);
  for (std::uint8_t i = 0; i < 6; ++i) {
    table['A' + i] = static_cast<std::int8_t>(10 + i);
    table['a' + i] = static_cast<std::int8_t>(10 + i);
  }
  return table;
}();

constexpr std::size_t kMaxDigits = 8;  // of 32 bits

}  // namespace

TextReader::TextReader(std::string_view text) : text_(text) {
  while (!text_.empty() && text_.back() == ' ') text_.remove_suffix(1);
}

std::string_view TextReader::token() {
  if (text_.empty()) fail(FieldFailure::TooShort);
  if (!ok()) return {};
  const auto length = std::min(text_.find(' '), text_.size());
  const auto found = text_.substr(0, length);
  text_.remove_prefix(std::min(length + 1, text_.size()));
  return found;
}

std::uint32_t TextReader::hexadecimal(std::string_view token, std::uint32_t largest) {
  if (token.empty()) fail(FieldFailure::NotANumber);
  while (token.size() > kMaxDigits && token.front() == '0') token.remove_prefix(1);
  if (token.size() > kMaxDigits) fail(FieldFailure::OutOfRange);
  if (!ok()) return 0;
  std::uint32_t value = 0;
  std::int8_t worst = 0;
  for (const char c : token) {
    const std::int8_t digit = kDigits[static_cast<std::uint8_t>(c)];
    worst = std::min(worst, digit);
    value = (value << 4U) | (static_cast<std::uint8_t>(digit) & 0xFU);
  }
  if (worst < 0) fail(FieldFailure::NotANumber);
  if (value > largest) fail(FieldFailure::OutOfRange);
  return value;
}

std::int64_t TextReader::decimal(std::string_view token, std::int64_t smallest, std::int64_t largest) {
  if (!ok()) return 0;
  if (token.front() == '+') token.remove_prefix(token.starts_with("+-") ? token.size() : 1);
  std::int64_t value = 0;
  const auto* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  const bool too_long = error == std::errc::result_out_of_range;
  if (!too_long && (error != std::errc() || stop != end)) {
    fail(FieldFailure::NotANumber);
  } else if (too_long || value < smallest || value > largest) {
    fail(FieldFailure::OutOfRange);
  }
  return value;
}

void TextReader::text(std::string& value, std::size_t length) {
  if (!ok()) return;
  if (length == 0) {  // an empty text may leave its two separators behind, or just one
    value.clear();
    if (!text_.empty() && text_.front() == ' ') text_.remove_prefix(1);
    return;
  }
  if (length > text_.size()) return fail(FieldFailure::TooShort);
  if (length < text_.size() && text_[length] != ' ') return fail(FieldFailure::BadText);
  value = text_.substr(0, length);
  text_.remove_prefix(std::min(length + 1, text_.size()));
}

void TextReader::values(std::vector<std::uint16_t>& out, std::size_t count, std::size_t width) {
  if (2 * count > text_.size() + 1) fail(FieldFailure::TooShort);  // a digit and a space each
  if (!ok()) return;
  out.resize(count);
  const std::uint32_t largest = width == 1 ? 0xFF : 0xFFFF;
  for (auto& value : out) value = static_cast<std::uint16_t>(hexadecimal(token(), largest));
}

std::size_t TextReader::count_tokens() {
  return text_.empty() ? 0 : static_cast<std::size_t>(std::count(text_.begin(), text_.end(), ' ')) + 1;
}

void TextWriter::text(std::string_view value, std::size_t length) {
  if (length == 0) return;
  out_.push_back(' ');
  out_.insert(out_.end(), value.begin(), value.end());
}

void TextWriter::values(const std::vector<std::uint16_t>& in, std::size_t count, std::size_t /*width*/) {
  for (std::size_t i = 0; i < count; ++i) hexadecimal(in[i], 1);
}

void TextWriter::hexadecimal(std::uint32_t value, int digits) {
  constexpr std::string_view kHexadecimal = "0123456789ABCDEF";
  digits = std::max(digits, (static_cast<int>(std::bit_width(value)) + 3) / 4);
  out_.push_back(' ');
  for (int i = digits; i-- > 0;)
    out_.push_back(static_cast<std::uint8_t>(kHexadecimal[(value >> (4 * i)) & 0xF]));
}

}  // namespace crisp::wire
