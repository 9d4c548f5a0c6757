// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace crisp
