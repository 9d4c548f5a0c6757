// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "grabbers/bag/chunked_bag_reader.hpp"

namespace crisp::bag {

/// Reads ROS 1's bags, version 2.0 (wiki.ros.org/Bags/Format/2.0), from front to back: their index is not
/// needed, so that one that was not closed (.bag.active) or was cut off is read as far as it goes.
class Rosbag1Reader final : public ChunkedBagReader {
 public:
  static constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

  /// @param in  at its begin
  explicit Rosbag1Reader(std::istream& in);

 private:
  struct Record;
  bool take_record() override;
  void take_record_of(ByteCursor& chunk) override;
  /// Reads the next record outside of chunks. False at the end.
  bool read_record();
  void use(const Record& record);
  void take_chunk(const Record& record);
  void connect(const Record& record);

  std::string header_, data_;
  std::map<std::uint32_t, std::size_t> index_;  ///< of a connection's number in the bag
};

}  // namespace crisp::bag
