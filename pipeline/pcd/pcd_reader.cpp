// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

#include <crisp/error.hpp>
#include <crisp/pcd_table.hpp>

#include "pipeline/files/control_characters.hpp"
#include "pipeline/files/yaml.hpp"
#include "pipeline/pcd/pcd_number.hpp"

namespace crisp {
namespace {

constexpr std::size_t kMaxExpansion = 264;  // LZF's longest match takes three bytes, at the least

/// Reads the body after a header, and checks it against the header.
class BodyReader {
 public:
  BodyReader(const PcdHeader& header, std::string_view file, const std::string& name)
      : header_(header),
        file_(file),
        body_(file.substr(header.data_begin)),
        name_(name),
        record_(header.record_size()) {
    for (const auto& field : header.fields) values_ += field.count;
  }

  /// Points behind those that the header counts, once it has read those.
  std::size_t surplus() const { return surplus_; }

  /// All fields' values, one field after the other.
  std::string read() {
    if (header_.format == PcdFormat::ascii) return read_ascii();
    return header_.format == PcdFormat::binary ? read_binary() : read_compressed();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + " " + what, "it is damaged or was cut off: use an intact copy");
  }

  /// Sizes the columns, unless there cannot be as many points in `most` bytes.
  std::string room_for_points(std::size_t most) const {
    if (header_.points > most / record_) {
      fail(fmt::format("is too short for the {} points of its header", header_.points));
    }
    return std::string(header_.points * record_, '\0');
  }

  template <class Put>
  void for_each_value(std::string& columns, Put put) const {
    std::vector<char*> at;
    char* next = columns.data();
    for (const auto& field : header_.fields) {
      at.push_back(next);
      next += field.width() * header_.points;
    }
    for (std::size_t row = 0; row < header_.points; ++row) {
      for (std::size_t f = 0; f < at.size(); ++f) {
        put(header_.fields[f], at[f], row);
        at[f] += header_.fields[f].width();
      }
    }
  }

  std::string read_binary() {
    std::string columns = room_for_points(body_.size());
    surplus_ = body_.size() / record_ - header_.points;
    const char* from = body_.data();
    for_each_value(columns, [&](const PcdField& field, char* to, std::size_t) {
      std::memcpy(to, from, field.width());
      from += field.width();
    });
    return columns;
  }

  std::string read_compressed() const {
    if (header_.points == 0) return {};
    std::array<std::uint32_t, 2> sizes{};  // compressed, and what it becomes
    if (body_.size() < sizeof sizes) fail("ends before its points");
    std::memcpy(sizes.data(), body_.data(), sizeof sizes);
    const auto compressed = body_.substr(sizeof sizes);
    if (sizes[0] > compressed.size()) fail("is cut off within its points");
    std::string columns = room_for_points(std::size_t{sizes[0]} * kMaxExpansion);
    if (sizes[1] != columns.size()) fail("does not hold as many bytes as its header states");
    if (lzf_decompress(compressed.data(), sizes[0], columns.data(), sizes[1]) != sizes[1]) {
      fail("has compressed points that cannot be decompressed");
    }
    return columns;
  }

  std::string read_ascii() {
    // A value takes a digit and a blank at least, and 8 bytes of ours at most.
    if (header_.points > 0 && values_ > (body_.size() + 1) / 2 / header_.points) {
      fail(fmt::format("is too short for the {} points of its header", header_.points));
    }
    std::string columns(header_.points * record_, '\0');
    for_each_value(columns, [&](const PcdField& field, char* to, std::size_t row) {
      if (&field == header_.fields.data()) begin_point(row);
      pcd::visit_number(field, [&]<PcdNumber T>(T) {
        for (std::size_t i = 0; i < field.count; ++i) {
          const T value = number_of<T>(next_word(), row);
          std::memcpy(to + i * sizeof(T), &value, sizeof(T));
        }
      });
    });
    refuse_more_values();
    while (next_line()) ++surplus_;
    return columns;
  }

  /// Moves on to the next line that is not blank; false at the end.
  bool next_line() {
    body_.remove_prefix(std::min(body_.find_first_not_of(kBlank), body_.size()));
    line_ = body_.substr(0, body_.find('\n'));
    body_.remove_prefix(line_.size());
    return !line_.empty();
  }

  void begin_point(std::size_t row) {
    refuse_more_values();
    if (!next_line()) fail(fmt::format("ends after {} of its {} points", row, header_.points));
    words_ = 0;
  }

  /// Empty at the end of the line.
  std::string_view next_word() {
    line_.remove_prefix(std::min(line_.find_first_not_of(kBlank), line_.size()));
    const auto word = line_.substr(0, line_.find_first_of(kBlank));
    line_.remove_prefix(word.size());
    if (word.empty()) fail_in_line(fmt::format("{} values, where a point has {}", words_, values_));
    ++words_;
    return word;
  }

  void refuse_more_values() {
    if (line_.find_first_not_of(kBlank) == std::string_view::npos) return;
    while (line_.find_first_not_of(kBlank) != std::string_view::npos) next_word();
    fail_in_line(fmt::format("{} values, where a point has {}", words_, values_));
  }

  [[noreturn]] void fail_in_line(const std::string& what) const {
    const auto before = file_.substr(0, file_.size() - body_.size());
    const auto line = std::ranges::count(before, '\n') + 1;
    throw Error(
        "the line has " + what,
        "each point is a line of as many values as FIELDS and COUNT give; the file is damaged, or FIELDS is wrong",
        {.file = name_, .line = static_cast<int>(line), .column = 1});
  }

  /// The number that a word is as a whole; nothing if it is none. A plus may stand before it.
  template <PcdNumber T>
  static std::optional<T> whole_word(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_read = code == std::errc() && end == word.data() + word.size();
    return is_read && !word.empty() ? std::optional(value) : std::nullopt;
  }

  /// A whole number that is written as 4.0 or 4e0; nothing if it is none, or too large to be known exactly.
  template <PcdNumber T>
  static std::optional<T> written_as_real(std::string_view word) {
    constexpr double kLargestExact = 9007199254740992;
    const auto real = whole_word<double>(word);
    if (!real || std::trunc(*real) != *real || std::abs(*real) > kLargestExact) return std::nullopt;
    const auto whole = static_cast<std::int64_t>(*real);
    return std::in_range<T>(whole) ? std::optional(static_cast<T>(whole)) : std::nullopt;
  }

  template <PcdNumber T>
  T number_of(std::string_view word, std::size_t row) const {
    if (word.starts_with('+')) {
      if (const auto value = whole_word<T>(word)) return *value;
    }
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if constexpr (std::same_as<T, float>) {  // beyond a float's range: zero or infinity, as a cast makes it
      if (code == std::errc::result_out_of_range) return static_cast<float>(number_of<double>(word, row));
    }
    if constexpr (std::integral<T>) {
      if (end != word.data() + word.size()) {
        if (const auto whole = written_as_real<T>(word)) return *whole;
      }
    }
    if (code != std::errc() || end != word.data() + word.size() || word.empty()) {
      fail_in_line(fmt::format("'{}' in place of a number, in point {}", files::shown(word), row + 1));
    }
    return value;
  }

  static constexpr std::string_view kBlank = " \t\r\n";

  const PcdHeader& header_;
  std::string_view file_;
  std::string_view body_;  ///< what of it was not read
  std::string_view line_;  ///< in ASCII: what of the current line was not read
  std::size_t words_ = 0;  ///< that were read of that line
  const std::string& name_;
  std::size_t record_;      ///< [bytes] of a point
  std::size_t values_ = 0;  ///< of a point
  std::size_t surplus_ = 0;
};

}  // namespace

PcdTable parse_pcd(std::string_view bytes, const std::string& name) {
  PcdHeader header = parse_pcd_header(bytes, name);
  BodyReader body(header, bytes, name);
  std::string columns = body.read();
  const std::size_t surplus = body.surplus();
  return {std::move(header), std::move(columns), surplus};
}

PcdTable read_pcd(const std::filesystem::path& file) {
  std::error_code missing;  // reported by reading
  const auto size = std::filesystem::file_size(file, missing);
  return parse_pcd(files::read_text_file(file, missing ? 0 : size), file.string());
}

}  // namespace crisp
