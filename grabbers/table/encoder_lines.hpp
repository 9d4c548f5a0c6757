// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <crisp/error.hpp>
#include <crisp/rig.hpp>
#include <crisp/scan.hpp>

#include "grabbers/table/table_format.hpp"
#include "grabbers/table/table_lines.hpp"

namespace crisp::table {

/// Reads the lines of an encoder from a text: those of the rig's format, or sentences of $PPLT. Other lines
/// are left out and counted; memory does not depend on the length of the text.
class EncoderLines {
 public:
  /// @param name   of the text, for places
  /// @param own    format of the lines; nothing: sentences of $PPLT
  /// @param stamp  unit of the time of receipt before each line; nothing: a line's own time is that of its
  ///               receipt, too
  EncoderLines(std::istream& in, std::string name, std::optional<EncoderLine> own,
               std::optional<TimeUnit> stamp)
      : lines_(in, name), name_(std::move(name)), own_(std::move(own)), stamp_(stamp) {}

  /// The next reading; nothing at the end. @throws Error where the text cannot be read
  std::optional<PlateReading> next();

  /// Number of lines that are no reading, by their fault.
  const std::map<std::string, std::uint64_t>& losses() const { return losses_; }
  /// The first damaged line; nothing if there was none.
  const std::optional<Error>& first_fault() const { return first_fault_; }
  std::uint64_t readings() const { return readings_; }  ///< so far

 private:
  bool take_stamp(std::string_view& line, PlateReading& reading) const;
  bool take_own_time(PlateReading& reading);
  void note_fault(std::string what);

  TableLines lines_;
  std::string name_;
  std::optional<EncoderLine> own_;
  std::optional<TimeUnit> stamp_;
  std::optional<std::int64_t> last_us_;  ///< own time, continued over the wraps of 32 bits
  std::uint64_t readings_ = 0;
  std::map<std::string, std::uint64_t> losses_;
  std::optional<Error> first_fault_;
};

}  // namespace crisp::table
