// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "grabbers/bag/chunked_bag_reader.hpp"

namespace crisp::bag {

/// Reads MCAP files (mcap.dev/spec) from front to back: their index is not needed, so that one that was not
/// closed is read as far as it goes.
class McapReader final : public ChunkedBagReader {
 public:
  static constexpr std::string_view kMagic = "\x89MCAP0\r\n";

  /// @param in  at its begin
  explicit McapReader(std::istream& in);

 private:
  struct Schema {
    std::string name, definition;
  };
  bool take_record() override;
  void take_record_of(ByteCursor& chunk) override;
  /// Reads the next record outside of chunks. False at the end.
  bool read_record();
  void use(std::uint8_t op, std::string_view content);
  void take_chunk(ByteCursor content);
  void add_schema(ByteCursor content);
  void add_channel(ByteCursor content);
  void take_message(ByteCursor content);

  std::uint8_t op_ = 0;
  std::string content_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, std::size_t> index_;  ///< of a channel's number in the file
};

}  // namespace crisp::bag
