// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>

#include "pipeline/data/error.hpp"
#include "pipeline/files/control_characters.hpp"
#include "pipeline/files/yaml.hpp"
#include "pipeline/pcd/pcd_number.hpp"
#include "pipeline/pcd/pcd_table.hpp"

namespace crisp {
namespace {

constexpr std::size_t kMostExpansion = 264;  // LZF's longest match takes three bytes, at the least

/// What follows a header, and the header's claims held against it.
class BodyReader {
 public:
  BodyReader(const PcdHeader& header, std::string_view body, const std::string& name)
      : header_(header), body_(body), name_(name), record_(header.record_size()) {}

  /// All fields' values, one field after the other.
  std::string read() {
    if (header_.format == PcdFormat::ascii) return read_ascii();
    return header_.format == PcdFormat::binary ? read_binary() : read_compressed();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + " " + what, "the file is damaged or was cut off");
  }

  /// Sizes the columns, unless there cannot be as many points in `most` bytes.
  std::string room_for_points(std::size_t most) const {
    if (header_.points > most / record_) {
      fail(fmt::format("says that it has {} points, but it is too short for them", header_.points));
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

  std::string read_binary() const {
    std::string columns = room_for_points(body_.size());
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
    std::string columns = room_for_points(std::size_t{sizes[0]} * kMostExpansion);
    if (sizes[1] != columns.size()) fail("does not hold as many bytes as its header says");
    if (lzf_decompress(compressed.data(), sizes[0], columns.data(), sizes[1]) != sizes[1]) {
      fail("has compressed points that cannot be expanded");
    }
    return columns;
  }

  std::string read_ascii() {
    std::size_t values = 0;
    for (const auto& field : header_.fields) values += field.count;
    // A value takes a digit and a blank at least, and 8 bytes of ours at most.
    if (header_.points > 0 && values > (body_.size() + 1) / 2 / header_.points) {
      fail(fmt::format("says that it has {} points, but it is too short for them", header_.points));
    }
    std::string columns(header_.points * record_, '\0');
    for_each_value(columns, [&](const PcdField& field, char* to, std::size_t row) {
      visit_number(field, [&]<PcdNumber T>(T) {
        for (std::size_t i = 0; i < field.count; ++i) {
          const T value = next_value<T>(row);
          std::memcpy(to + i * sizeof(T), &value, sizeof(T));
        }
      });
    });
    return columns;
  }

  template <PcdNumber T>
  T next_value(std::size_t row) {
    constexpr std::string_view kBlank = " \t\r\n";
    body_.remove_prefix(std::min(body_.find_first_not_of(kBlank), body_.size()));
    const auto word = body_.substr(0, body_.find_first_of(kBlank));
    body_.remove_prefix(word.size());
    return number_of<T>(word, row);
  }

  template <PcdNumber T>
  T number_of(std::string_view word, std::size_t row) const {
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if constexpr (std::same_as<T, float>) {  // beyond a float's range: zero or infinity, as a cast makes it
      if (code == std::errc::result_out_of_range) return static_cast<float>(number_of<double>(word, row));
    }
    if (code != std::errc() || end != word.data() + word.size() || word.empty()) {
      fail(fmt::format("has '{}' in place of a number, in point {}", shown(word), row + 1));
    }
    return value;
  }

  const PcdHeader& header_;
  std::string_view body_;
  const std::string& name_;
  std::size_t record_;
};

}  // namespace

PcdTable parse_pcd(std::string_view bytes, const std::string& name) {
  PcdHeader header = parse_pcd_header(bytes, name);
  std::string columns = BodyReader(header, bytes.substr(header.data_begin), name).read();
  return {std::move(header), std::move(columns)};
}

PcdTable read_pcd(const std::filesystem::path& file) {
  std::error_code missing;  // is said by reading
  const auto size = std::filesystem::file_size(file, missing);
  return parse_pcd(read_text_file(file, missing ? 0 : size), file.string());
}

}  // namespace crisp
