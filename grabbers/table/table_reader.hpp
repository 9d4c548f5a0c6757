// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <crisp/error.hpp>

#include "grabbers/table/table_format.hpp"
#include "grabbers/table/table_lines.hpp"

namespace crisp::table {

/// Reads a table of scans, or of single beams, row by row: numbers apart by commas, semicolons, tabs or
/// spaces. Lines that are empty or begin with # or % are no rows, nor is a first line of names. A row that
/// cannot be read is left out and counted; memory does not depend on the length of the table.
class TableReader {
 public:
  /// @param name  of the table, for places
  TableReader(std::istream& in, std::string name, const TableFormat& format)
      : lines_(in, name), name_(std::move(name)), format_(format) {}

  /// The next row that can be read, or nothing at the end. @throws Error as TableLines, and where
  /// numbers have decimal commas, which are indistinguishable from the commas between numbers
  std::optional<TableRow> next();

  /// Number of dropped rows, by their fault.
  const std::map<std::string, std::uint64_t>& losses() const { return losses_; }
  /// The first fault with its place; nothing if all rows could be read.
  const std::optional<Error>& first_fault() const { return first_fault_; }
  std::uint64_t rows() const { return rows_; }  ///< that could be read so far

 private:
  std::optional<TableRow> parse(std::string_view text);

  TableLines lines_;
  std::string name_;
  TableFormat format_;
  std::uint64_t rows_ = 0;
  std::map<std::string, std::uint64_t> losses_;
  std::optional<Error> first_fault_;
};

}  // namespace crisp::table
