// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crisp::bag {

/// Encoding of a message's fields.
enum class RosEncoding {
  ros1,   ///< packed
  cdr,    ///< ROS 2: aligned, after four bytes that name the order of bytes
  other,  ///< not known here
};

/// A topic of a bag with the type of its messages.
struct BagConnection {
  std::string topic;
  std::string type;  ///< "sensor_msgs/LaserScan", without ROS 2's "/msg"
  std::string
      definition;  ///< of the type and all that it holds, in ROS' language; empty where the bag has none
  RosEncoding encoding = RosEncoding::other;
};

/// A message as it lies in a bag.
struct BagMessage {
  std::size_t connection = 0;   ///< index in BagReader::connections()
  std::int64_t receipt_ns = 0;  ///< [ns since the Unix epoch] when the recorder received it
  std::string_view data;        ///< until the next call of next()
};

/// The messages of a bag from its front to its back, in the order in which they were recorded. What is
/// damaged is left out and counted; memory does not grow with the bag.
class BagReader {
 public:
  BagReader(const BagReader&) = delete;
  BagReader& operator=(const BagReader&) = delete;
  virtual ~BagReader() = default;

  /// The next message; nothing at the end. @throws Error if the disk fails
  virtual std::optional<BagMessage> next() = 0;

  /// All connections so far; a message belongs to one of them.
  const std::vector<BagConnection>& connections() const { return connections_; }
  const std::map<std::string, std::uint64_t>& losses() const { return losses_; }
  const char* format() const { return format_; }  ///< "rosbag 1", for people

 protected:
  explicit BagReader(const char* format) : format_(format) {}
  void count(const char* what) { ++losses_[what]; }
  /// @return its index
  std::size_t add(BagConnection connection) {
    connections_.push_back(std::move(connection));
    return connections_.size() - 1;
  }

 private:
  const char* format_;
  std::vector<BagConnection> connections_;
  std::map<std::string, std::uint64_t> losses_;
};

}  // namespace crisp::bag
