// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/bag/bag_reader.hpp"
#include "grabbers/bag/byte_cursor.hpp"
#include "grabbers/bag/exact_reader.hpp"

namespace crisp {

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

  void open_chunk(std::string content) {
    chunk_ = std::move(content);
    left_ = ByteCursor(chunk_);
  }
  void give(const BagMessage& message) { message_ = message; }

  ExactReader in_;

 private:
  std::string chunk_;
  ByteCursor left_{{}};  ///< of the chunk
  std::optional<BagMessage> message_;
};

}  // namespace crisp
