// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>

#include "grabbers/bag/bag_reader.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace crisp::bag {

/// Reads ROS 2's bags in SQLite (rosbag2_storage_sqlite3, .db3), in the order of their receipt times.
class SqliteReader final : public BagReader {
 public:
  static constexpr std::string_view kMagic{"SQLite format 3\0", 16};

  /// @throws Error if the file cannot be read, or holds no bag
  explicit SqliteReader(std::filesystem::path file);

  std::optional<BagMessage> next() override;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  Statement prepare(const char* query) const;
  /// Whether there is a further row. @throws Error if the file is damaged and nothing was read
  bool step(sqlite3_stmt* statement);
  std::map<std::string, std::string> definitions();
  bool has_table(const char* name);

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> database_;
  Statement messages_;
  std::map<std::int64_t, std::size_t> index_;  ///< of a topic's number in the file
};

}  // namespace crisp::bag
