// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/chunked_bag_reader.hpp"

namespace crisp::bag {

std::optional<BagMessage> ChunkedBagReader::next() {
  message_.reset();
  while (!message_) {
    try {
      if (!left_.empty()) {
        take_record_of(left_);
      } else if (!take_record()) {
        return std::nullopt;
      }
    } catch (const BagDamage& damage) {
      count(damage.what);
      left_ = ByteCursor({});
    }
  }
  return message_;
}

}  // namespace crisp::bag
