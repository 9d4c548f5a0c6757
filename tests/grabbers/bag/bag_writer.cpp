// SPDX-License-Identifier: BSD-3-Clause
#include "tests/grabbers/bag/bag_writer.hpp"

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include "tests/support/temporary_folder.hpp"

namespace crisp::test {
namespace {

template <class T>
std::string raw(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}
std::string with_length(const std::string& bytes) {
  return raw(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

std::string compressed(const std::string& method, const std::string& bytes) {
  std::string out(2 * bytes.size() + 1000, '\0');
  if (method == "bz2") {
    auto size = static_cast<unsigned>(out.size());
    std::string in = bytes;
    EXPECT_EQ(
        BZ2_bzBuffToBuffCompress(out.data(), &size, in.data(), static_cast<unsigned>(in.size()), 9, 0, 0),
        BZ_OK);
    out.resize(size);
  } else if (method == "lz4") {
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  } else if (method == "zstd") {
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  } else {
    return bytes;
  }
  return out;
}

std::string field(const std::string& name, const std::string& value) {
  return with_length(name + "=" + value);
}
std::string record1(const std::string& header, const std::string& data) {
  return with_length(header) + with_length(data);
}

std::string connection1(const TestBag& bag, std::uint32_t i) {
  const TestTopic& topic = bag.topics[i];
  return record1(field("op", "\x07") + field("conn", raw(i)) + field("topic", topic.name),
                 field("topic", topic.name) + field("type", topic.type) + field("md5sum", "*") +
                     field("message_definition", topic.definition));
}

std::string message1(const TestMessage& message) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::string time = raw(static_cast<std::uint32_t>(message.receipt_ns / kSecond)) +
                           raw(static_cast<std::uint32_t>(message.receipt_ns % kSecond));
  return record1(field("op", "\x02") + field("conn", raw(static_cast<std::uint32_t>(message.topic))) +
                     field("time", time),
                 message.bytes);
}

std::string record_m(std::uint8_t op, const std::string& content) {
  return raw(op) + raw(static_cast<std::uint64_t>(content.size())) + content;
}

std::string channels_m(const TestBag& bag) {
  std::string all;
  for (std::size_t i = 0; i < bag.topics.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(i + 1);
    const auto& [name, type, definition] = bag.topics[i];
    const bool is_ros2 = type.find("/msg/") != std::string::npos;
    all += record_m(3, raw(id) + with_length(type) + with_length(is_ros2 ? "ros2msg" : "ros1msg") +
                           with_length(definition));
    all += record_m(
        4, raw(id) + raw(id) + with_length(name) + with_length(is_ros2 ? "cdr" : "ros1") + with_length(""));
  }
  return all;
}

void run(sqlite3* database, const char* statement) {
  EXPECT_EQ(sqlite3_exec(database, statement, nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
}

}  // namespace

const char* const kLaserScanDefinition =
    "# Single scan\nHeader header  # timestamp of the first ray\nfloat32 angle_min # [rad]\nfloat32 angle_max\n"
    "float32 angle_increment\n\nfloat32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
    "float32[] ranges\nfloat32[] intensities\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\n# Standard metadata\nuint32 seq\ntime stamp\nstring frame_id\n";
const char* const kMultiEchoDefinition =
    "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\n"
    "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nLaserEcho[] ranges\nLaserEcho[] intensities\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: sensor_msgs/LaserEcho\nfloat32[] echoes\n";
const char* const kJointStateDefinition =
    "Header header\n\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";

void put_scan(RosBytes& to, const TestScan& scan) {
  to.header(scan.stamp_ns);
  const auto last = static_cast<float>(scan.ranges.size()) - 1;
  for (const float value :
       {scan.angle_min, scan.angle_min + last * scan.angle_increment, scan.angle_increment,
        scan.time_increment, scan.scan_time, scan.range_min, scan.range_max}) {
    to.put(value);
  }
  to.list(scan.ranges).list(scan.intensities);
}

std::string scan_bytes(const TestScan& scan, bool cdr) {
  RosBytes bytes(cdr);
  put_scan(bytes, scan);
  return bytes.bytes();
}

std::string joints_bytes(std::int64_t stamp_ns, const std::vector<std::string>& names,
                         const std::vector<double>& positions, bool cdr) {
  RosBytes bytes(cdr);
  bytes.header(stamp_ns).put(static_cast<std::uint32_t>(names.size()));
  for (const auto& name : names) bytes.text(name);
  bytes.list(positions).list<double>({}).list<double>({});
  return bytes.bytes();
}

void write_rosbag1(const std::filesystem::path& file, const TestBag& bag, const std::string& compression) {
  std::string records;
  for (std::uint32_t i = 0; i < bag.topics.size(); ++i) records += connection1(bag, i);
  for (const auto& message : bag.messages) records += message1(message);
  std::string bytes =
      "#ROSBAG V2.0\n" +
      record1(field("op", "\x03") + field("index_pos", raw(std::uint64_t{0})) +
                  field("conn_count", raw(std::uint32_t{0})) + field("chunk_count", raw(std::uint32_t{1})),
              std::string(4000, ' '));
  if (compression.empty()) {
    bytes += records;
  } else {
    bytes += record1(field("op", "\x05") + field("compression", compression) +
                         field("size", raw(static_cast<std::uint32_t>(records.size()))),
                     compressed(compression, records));
  }
  for (std::uint32_t i = 0; i < bag.topics.size(); ++i) bytes += connection1(bag, i);  // the index
  put_bytes(file, bytes);
}

void write_mcap(const std::filesystem::path& file, const TestBag& bag, const std::string& compression) {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string records = channels_m(bag);
  for (const auto& message : bag.messages) {
    const auto time = static_cast<std::uint64_t>(message.receipt_ns);
    records += record_m(5, raw(static_cast<std::uint16_t>(message.topic + 1)) + raw(std::uint32_t{0}) +
                               raw(time) + raw(time - 1000) + message.bytes);
  }
  std::string bytes = magic + record_m(1, with_length("ros2") + with_length("test"));
  if (compression == "unchunked") {
    bytes += records;
  } else {
    const auto crc = crc32_z(0, reinterpret_cast<const unsigned char*>(records.data()), records.size());
    const std::string chunk = compressed(compression, records);
    bytes += record_m(6, raw(std::uint64_t{0}) + raw(std::uint64_t{0}) +
                             raw(static_cast<std::uint64_t>(records.size())) +
                             raw(static_cast<std::uint32_t>(crc)) + with_length(compression) +
                             raw(static_cast<std::uint64_t>(chunk.size())) + chunk);
  }
  bytes += record_m(0x0f, raw(std::uint32_t{0}));
  bytes += channels_m(bag);  // the summary
  bytes += record_m(2, raw(std::uint64_t{0}) + raw(std::uint64_t{0}) + raw(std::uint32_t{0}));
  put_bytes(file, bytes + magic);
}

void write_db3(const std::filesystem::path& file, const TestBag& bag) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  run(database, "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)");
  run(database,
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
  run(database,
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)");
  run(database, "CREATE INDEX timestamp_idx ON messages (timestamp ASC); BEGIN");
  for (std::size_t i = 0; i < bag.topics.size(); ++i) {
    run(database, ("INSERT INTO topics VALUES(" + std::to_string(i + 1) + ", '" + bag.topics[i].name +
                   "', '" + bag.topics[i].type + "', 'cdr', '')")
                      .c_str());
  }
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1, &insert,
                     nullptr);
  for (const auto& message : bag.messages) {
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(message.topic + 1));
    sqlite3_bind_int64(insert, 2, message.receipt_ns);
    sqlite3_bind_blob(insert, 3, message.bytes.data(), static_cast<int>(message.bytes.size()),
                      SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  run(database, "COMMIT");
  sqlite3_close(database);
}

}  // namespace crisp::test
