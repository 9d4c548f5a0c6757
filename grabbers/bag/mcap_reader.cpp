// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/mcap_reader.hpp"

#include <zlib.h>

#include <utility>

#include "grabbers/bag/decompress.hpp"
#include "grabbers/bag/ros_names.hpp"

namespace crisp::bag {
namespace {

/// Kind of a record, by its first byte.
enum McapOp : std::uint8_t { kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6 };

bool is_of_interest(std::uint8_t op) { return op >= kSchema && op <= kChunk; }

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

RosEncoding encoding_of(std::string_view name) {
  if (name == "ros1") return RosEncoding::ros1;
  return name == "cdr" ? RosEncoding::cdr : RosEncoding::other;
}

}  // namespace

McapReader::McapReader(std::istream& in) : ChunkedBagReader("MCAP", in) {
  if (!in_.read(kMagic.size(), content_) || content_ != kMagic) count("bags whose begin is missing");
}

bool McapReader::read_record() {
  constexpr std::size_t kBegin = 1 + sizeof(std::uint64_t);
  if (in_.at_end()) return false;
  std::string begin;
  if (!in_.read(kMagic.size(), begin)) {
    count("bags that end within a record");
    return false;
  }
  if (begin == kMagic) return false;  // it stands at the end, too
  std::string rest;
  if (in_.read(kBegin - kMagic.size(), rest)) {
    ByteCursor cursor(begin += rest);
    op_ = cursor.take<std::uint8_t>();
    const auto length = cursor.take<std::uint64_t>();
    if (is_of_interest(op_) ? in_.read(length, content_) : in_.skip(length)) return true;
  }
  count("bags that end within a record");
  return false;
}

void McapReader::add_schema(ByteCursor content) {
  const auto id = content.take<std::uint16_t>();
  const std::string_view name = content.text();
  const bool is_msg = content.text().ends_with("msg");  // ros1msg, ros2msg: else in a language not known here
  schemas_[id] = {std::string(name), is_msg ? std::string(content.text()) : ""};
}

void McapReader::add_channel(ByteCursor content) {
  const auto id = content.take<std::uint16_t>();
  if (index_.contains(id)) return;
  const Schema& schema = schemas_[content.take<std::uint16_t>()];
  const std::string_view topic = content.text();
  index_[id] = add({.topic = std::string(topic),
                    .type = plain_ros_type(schema.name),
                    .definition = schema.definition,
                    .encoding = encoding_of(content.text())});
}

void McapReader::take_chunk(ByteCursor content) {
  content.bytes(2 * sizeof(std::uint64_t));  // the times of its messages
  const auto size = content.take<std::uint64_t>();
  const auto crc = content.take<std::uint32_t>();
  const std::string_view method = content.text();
  const std::string_view chunk =
      decompress(method, content.bytes(content.take<std::uint64_t>()), size, room());
  if (crc != 0 && crc != crc_of(chunk)) throw BagDamage{"chunks with a wrong checksum"};
  open_chunk(chunk);
}

void McapReader::take_message(ByteCursor content) {
  const auto known = index_.find(content.take<std::uint16_t>());
  if (known == index_.end()) throw BagDamage{"messages of a connection that the bag does not describe"};
  content.take<std::uint32_t>();  // a count of the publisher's, often 0
  const auto received = static_cast<std::int64_t>(content.take<std::uint64_t>());
  content.take<std::uint64_t>();  // when it was published, often the same
  give({known->second, received, content.bytes(content.size())});
}

void McapReader::use(std::uint8_t op, std::string_view content) {
  if (op == kSchema) add_schema(ByteCursor(content));
  if (op == kChannel) add_channel(ByteCursor(content));
  if (op == kMessage) take_message(ByteCursor(content));
  if (op == kChunk) take_chunk(ByteCursor(content));
}

bool McapReader::take_record() {
  if (!read_record()) return false;
  use(op_, content_);
  return true;
}

void McapReader::take_record_of(ByteCursor& chunk) {
  const auto op = chunk.take<std::uint8_t>();
  const std::string_view content = chunk.bytes(chunk.take<std::uint64_t>());
  if (op == kChunk) throw BagDamage{"chunks within chunks"};
  use(op, content);
}

}  // namespace crisp::bag
