// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/bag/bag_reader.hpp"
#include "grabbers/bag/byte_cursor.hpp"
#include "grabbers/bag/exact_reader.hpp"

namespace crisp::bag {

/// A bag whose records lie in chunks, each compressed by itself, and between them. A damaged record costs the
/// rest of its chunk.
class ChunkedBagReader : public BagReader {
 public:
  std::optional<BagMessage> next() final;

 protected:
  /// @param in  at its begin
  ChunkedBagReader(const char* format, std::istream& in) : BagReader(format), in_(in) {}

  /// Reads the next record outside of chunks, and takes what is in it. False at the end.
  /// @throws BagDamage
  virtual bool take_record() = 0;
  /// The same of the next record in the chunk. @throws BagDamage
  virtual void take_record_of(ByteCursor& chunk) = 0;

  /// The memory in which chunks are decompressed.
  std::string& room() { return room_; }
  /// @param content  of a chunk: it stays until the next record outside of it is read
  void open_chunk(std::string_view content) { left_ = ByteCursor(content); }
  void give(const BagMessage& message) { message_ = message; }

  ExactReader in_;

 private:
  std::string room_;
  ByteCursor left_{{}};  ///< of the chunk
  std::optional<BagMessage> message_;
};

}  // namespace crisp::bag
