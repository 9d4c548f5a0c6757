// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <istream>
#include <string>

namespace crisp::table {

/// The lines of a text, in whatever way they end (LF, CRLF, or CR alone), without a byte order mark before
/// the first. Memory is bounded, whatever the text is.
class TableLines {
 public:
  /// A longer line is kept to one character more than this.
  static constexpr std::size_t kLongest = 1 << 20;

  /// @param name  of the text, for messages
  TableLines(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  /// Reads the next line without its end. False at the text's end.
  /// @throws Error  where the text cannot be read to its end, or is no lines
  bool next(std::string& line);
  int number() const { return number_; }  ///< of the line read last, from 1

 private:
  bool fill();
  void take(std::string& line, std::size_t n);

  std::istream& in_;
  std::string name_;
  std::string buffer_;
  std::size_t at_ = 0;         // in the buffer
  std::size_t length_ = 0;     // of the line so far
  bool after_return_ = false;  // the line before ended with CR: LF belongs to it
  bool begun_ = false;
  int number_ = 0;
};

}  // namespace crisp::table
