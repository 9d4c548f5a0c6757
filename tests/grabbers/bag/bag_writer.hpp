// SPDX-License-Identifier: BSD-3-Clause
// Writes bags after their formats' specifications (wiki.ros.org/Bags/Format/2.0, mcap.dev/spec, the schema of
// rosbag2_storage_sqlite3 version 3), with nothing of the reader's code.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace crisp::test {

/// The bytes of a message, in ROS 1's serialisation or in ROS 2's little-endian CDR.
class RosBytes {
 public:
  explicit RosBytes(bool cdr) : cdr_(cdr) {}

  template <class T>
  RosBytes& put(T value) {
    align(sizeof(T));
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  RosBytes& text(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + (cdr_ ? 1 : 0)));
    bytes_ += value;
    if (cdr_) bytes_ += '\0';
    return *this;
  }
  template <class T>
  RosBytes& list(const std::vector<T>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    for (const T value : values) put(value);
    return *this;
  }
  /// A std_msgs/Header: ROS 1's has a count before the stamp.
  RosBytes& header(std::int64_t stamp_ns) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    if (!cdr_) put(std::uint32_t{7});
    put(static_cast<std::uint32_t>(stamp_ns / kSecond));
    put(static_cast<std::uint32_t>(stamp_ns % kSecond));
    return text("laser_frame");
  }
  bool is_cdr() const { return cdr_; }
  std::string bytes() const { return cdr_ ? std::string("\0\1\0\0", 4) + bytes_ : bytes_; }

 private:
  void align(std::size_t size) {
    while (cdr_ && bytes_.size() % size != 0) bytes_ += '\0';
  }
  bool cdr_;
  std::string bytes_;
};

struct TestTopic {
  std::string name, type, definition;
};

struct TestMessage {
  std::size_t topic;
  std::int64_t receipt_ns;
  std::string bytes;
};

/// Content of a test's bag.
struct TestBag {
  std::vector<TestTopic> topics;
  std::vector<TestMessage> messages;
};

/// @param compression  "none", "bz2" or "lz4"; "" for messages outside of chunks
void write_rosbag1(const std::filesystem::path& file, const TestBag& bag, const std::string& compression);
/// @param compression  "", "lz4" or "zstd"; "unchunked" for messages outside of chunks
void write_mcap(const std::filesystem::path& file, const TestBag& bag, const std::string& compression);
void write_db3(const std::filesystem::path& file, const TestBag& bag);

/// The definitions as bags of ROS 1 hold them.
extern const char* const kLaserScanDefinition;
extern const char* const kMultiEchoDefinition;
extern const char* const kJointStateDefinition;

/// A sensor_msgs/LaserScan's numbers.
struct TestScan {
  std::int64_t stamp_ns = 0;
  float angle_min = 0, angle_increment = 0.01F, time_increment = 0, scan_time = 0, range_min = 0,
        range_max = 100;
  std::vector<float> ranges, intensities;
};
void put_scan(RosBytes& to, const TestScan& scan);
std::string scan_bytes(const TestScan& scan, bool cdr);
std::string joints_bytes(std::int64_t stamp_ns, const std::vector<std::string>& names,
                         const std::vector<double>& positions, bool cdr);

}  // namespace crisp::test
