// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>

namespace crisp::bag {

/// Exact numbers of bytes from a stream, whatever a damaged length claims: memory grows as bytes come.
class ExactReader {
 public:
  explicit ExactReader(std::istream& in) : in_(in) {}

  /// Reads so many bytes. False where the stream ends before.
  bool read(std::uint64_t n, std::string& to);
  /// Reads and forgets so many bytes.
  bool skip(std::uint64_t n);
  bool at_end() { return in_.peek() == std::istream::traits_type::eof(); }

 private:
  std::istream& in_;
};

}  // namespace crisp::bag
