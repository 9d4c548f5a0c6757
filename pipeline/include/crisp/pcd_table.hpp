// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

namespace crisp {

/// Encoding of the points after the header of a PCD file.
enum class PcdFormat { ascii, binary, binary_compressed };

/// One field of every point of a PCD file.
struct PcdField {
  std::string name;       ///< "x", "intensity"
  char type = 'F';        ///< 'F' floating point, 'I' signed, 'U' unsigned
  std::size_t size = 4;   ///< [bytes] of one element: 1, 2, 4 or 8
  std::size_t count = 1;  ///< elements of each point

  /// [bytes] of the field in one point.
  std::size_t width() const { return size * count; }
  /// Whether both describe the same field.
  bool operator==(const PcdField&) const = default;
};

/// The header of a PCD file (version 0.7, as PCL writes it).
///
/// PCD has no place for further data. crisp writes them in comment lines, "# crisp epoch_ns 17…", which every
/// reader of PCD files skips.
struct PcdHeader {
  std::vector<PcdField> fields;  ///< in the order in which a point holds them
  std::size_t points = 0;        ///< in all
  std::size_t rows = 1;          ///< HEIGHT: more than one where points stand in order of an image
  bool has_pose = false;         ///< whether VIEWPOINT is other than the origin; set by reading
  PcdFormat format = PcdFormat::binary_compressed;  ///< of the points
  std::map<std::string, std::string> notes;         ///< of crisp's comment lines: "epoch_ns" → "17…"
  std::size_t data_begin = 0;                       ///< [bytes] from the file's beginning; set by reading

  std::size_t record_size() const;                     ///< [bytes] of one point
  const PcdField* find(std::string_view field) const;  ///< nullptr if there is none

  /// A note as a number, or nothing where it is not there. @throws Error if it is not a number
  template <class T>
  std::optional<T> note(const std::string& key) const {
    const auto found = notes.find(key);
    if (found == notes.end()) return std::nullopt;
    const char* end = found->second.data() + found->second.size();
    T value{};
    const auto read = std::from_chars(found->second.data(), end, value);
    if (read.ec != std::errc() || read.ptr != end) {
      throw Error("'" + found->second + "' is no " + key, "the header's comments were changed");
    }
    return value;
  }
};

/// The header's text, up to and with the line DATA.
std::string to_text(const PcdHeader& header);

/// Reads the header at the beginning of a PCD file, and checks all that can be checked without the points.
/// @param file what the file begins with, or all of it
/// @param name of the file, for errors
/// @throws Error with line: no PCD file, contradictions, sizes that do not exist, the end before DATA
PcdHeader parse_pcd_header(std::string_view file, const std::string& name);

template <class T>
concept PcdNumber =
    (std::integral<T> && !std::same_as<T, bool>) || std::same_as<T, float> || std::same_as<T, double>;

/// The points of a PCD file as named columns, and the notes of its header. In memory a column follows the
/// other, as in a binary_compressed file.
class PcdTable {
 public:
  /// A table of that many points, without columns.
  explicit PcdTable(std::size_t rows) { header_.points = rows; }
  /// @param columns all the fields' values, one field after the other, in the header's order
  /// @param surplus number of points in the file beyond the header's count, which were not read
  PcdTable(PcdHeader header, std::string columns, std::size_t surplus = 0);

  std::size_t rows() const { return header_.points; }  ///< number of points
  std::size_t surplus() const { return surplus_; }     ///< points of the file beyond the header's count
  const PcdHeader& header() const { return header_; }  ///< fields and notes
  std::string_view bytes() const { return columns_; }  ///< all columns, one after the other
  bool has(std::string_view field) const {
    return header_.find(field) != nullptr;
  }  ///< whether there is such a column

  /// 16 hexadecimal digits that differ where the columns do.
  std::string digest() const;

  /// Sets a note of crisp in the header's comments; neither key nor value may hold blanks.
  void set_note(const std::string& key, std::string value) { header_.notes[key] = std::move(value); }

  /// Adds a column: `value_of(row)` gives each row's value.
  template <PcdNumber T, class ValueOf>
  void add(std::string name, ValueOf value_of) {
    constexpr char kType = std::floating_point<T> ? 'F' : std::signed_integral<T> ? 'I' : 'U';
    header_.fields.push_back({.name = std::move(name), .type = kType, .size = sizeof(T)});
    std::size_t end = columns_.size();
    columns_.resize(end + rows() * sizeof(T));
    for (std::size_t row = 0; row < rows(); ++row, end += sizeof(T)) {
      const T value = value_of(row);
      std::memcpy(columns_.data() + end, &value, sizeof(T));
    }
  }

  /// A column's values as numbers of type T, whatever type the file has them in.
  /// @throws Error if there is no such column of single elements, or a value is beyond a whole number T
  template <PcdNumber T>
  std::vector<T> column(std::string_view name) const;

 private:
  PcdHeader header_;
  std::string columns_;
  std::size_t surplus_ = 0;
};

/// Writes a PCD file in the requested format; a binary_compressed one can hold 4 GB. The same table
/// gives the same bytes.
/// @param out nothing was written to it; it is not committed
/// @throws Error if the points are too many for the format, or the disk is full
void write_pcd(AtomicFile& out, const PcdTable& table, PcdFormat format);

/// Reads a PCD file of any origin.
/// @throws Error if it cannot be read, its header is invalid, or its content does not match the header, in
///         ASCII a point a line
PcdTable read_pcd(const std::filesystem::path& file);

/// The same from memory. Needs no more memory than some 300 times the bytes, whatever the header claims.
/// @param name of the file, for errors
PcdTable parse_pcd(std::string_view bytes, const std::string& name);

/// Runs `read`, and puts the file's name before what it complains of.
template <class Read>
auto about(const std::filesystem::path& file, Read read) {
  try {
    return read();
  } catch (const Error& error) {
    throw Error(file.string() + ": " + error.message(), error.advice());
  }
}

}  // namespace crisp
