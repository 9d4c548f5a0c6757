// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/sqlite_reader.hpp"

#include <sqlite3.h>

#include <crisp/error.hpp>

#include "grabbers/bag/ros_names.hpp"

namespace crisp::bag {
namespace {

std::string text_of(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column))) : "";
}

}  // namespace

void SqliteReader::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }
void SqliteReader::Close::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

SqliteReader::SqliteReader(std::filesystem::path file)
    : BagReader("rosbag 2, SQLite"), file_(std::move(file)) {
  sqlite3* opened = nullptr;
  const int status = sqlite3_open_v2(file_.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
  database_.reset(opened);
  if (status != SQLITE_OK)
    throw Error("cannot read " + file_.string() + ": " + sqlite3_errstr(status),
                "check its name and its permissions");
  if (!has_table("topics") || !has_table("messages")) {
    throw Error(
        file_.string() + " is a database, but no bag of ROS 2: it lacks the tables topics and messages",
        "is it the right file?");
  }
  const auto known = definitions();
  const auto topics = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  while (step(topics.get())) {
    const std::string type = text_of(topics.get(), 2);
    const auto definition = known.find(type);
    index_[sqlite3_column_int64(topics.get(), 0)] =
        add({.topic = text_of(topics.get(), 1),
             .type = plain_ros_type(type),
             .definition = definition == known.end() ? "" : definition->second,
             .encoding = text_of(topics.get(), 3) == "cdr" ? RosEncoding::cdr : RosEncoding::other});
  }
  messages_ = prepare("SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
}

/// Newer bags hold the definitions of their types.
std::map<std::string, std::string> SqliteReader::definitions() {
  std::map<std::string, std::string> all;
  if (!has_table("message_definitions")) return all;
  const auto rows = prepare(
      "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE encoding = 'ros2msg'");
  while (step(rows.get())) all[text_of(rows.get(), 0)] = text_of(rows.get(), 1);
  return all;
}

bool SqliteReader::has_table(const char* name) {
  const auto table = prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?");
  sqlite3_bind_text(table.get(), 1, name, -1, SQLITE_STATIC);
  return step(table.get());
}

SqliteReader::Statement SqliteReader::prepare(const char* query) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), query, -1, &statement, nullptr) != SQLITE_OK) {
    throw Error("cannot read " + file_.string() + ": " + sqlite3_errmsg(database_.get()),
                "sqlite3 FILE .recover recovers a damaged one in part");
  }
  return Statement(statement);
}

bool SqliteReader::step(sqlite3_stmt* statement) {
  const int status = sqlite3_step(statement);
  if (status == SQLITE_ROW) return true;
  if (status != SQLITE_DONE) count("bags whose database is damaged: the rest of it");
  return false;
}

std::optional<BagMessage> SqliteReader::next() {
  while (step(messages_.get())) {
    const auto known = index_.find(sqlite3_column_int64(messages_.get(), 0));
    if (known == index_.end()) {
      count("messages of a connection that the bag does not describe");
      continue;
    }
    const auto* data = static_cast<const char*>(sqlite3_column_blob(messages_.get(), 2));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(messages_.get(), 2));
    return BagMessage{known->second, sqlite3_column_int64(messages_.get(), 1), {data, data ? size : 0}};
  }
  return std::nullopt;
}

}  // namespace crisp::bag
