// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/rosbag1_reader.hpp"

#include <algorithm>

#include "grabbers/bag/decompress.hpp"

namespace crisp::bag {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

/// Kind of a record, in the field `op` of its header.
enum class Op : std::uint8_t { message = 2, chunk = 5, connection = 7 };

/// The value of a field of a header: fields are NAME=VALUE after their length.
std::string_view field(std::string_view header, std::string_view name) {
  for (ByteCursor fields(header); !fields.empty();) {
    const std::string_view one = fields.text();
    const auto equals = one.find('=');
    if (equals == std::string_view::npos) throw BagDamage{"records with an unreadable header"};
    if (one.substr(0, equals) == name) return one.substr(equals + 1);
  }
  throw BagDamage{"records whose header lacks a field"};
}

template <class T>
T number(std::string_view header, std::string_view name) {
  return ByteCursor(field(header, name)).take<T>();
}

}  // namespace

struct Rosbag1Reader::Record {
  std::string_view header, data;
};

Rosbag1Reader::Rosbag1Reader(std::istream& in) : ChunkedBagReader("rosbag 1", in) {
  if (!in_.read(kMagic.size(), header_) || header_ != kMagic) count("bags whose begin is missing");
}

bool Rosbag1Reader::read_record() {
  std::string length;
  const auto read = [&](std::string& to) {
    return in_.read(sizeof(std::uint32_t), length) && in_.read(ByteCursor(length).take<std::uint32_t>(), to);
  };
  if (in_.at_end()) return false;
  if (read(header_) && read(data_)) return true;
  count("bags that end within a record");
  return false;
}

void Rosbag1Reader::connect(const Record& record) {
  const auto id = number<std::uint32_t>(record.header, "conn");
  if (index_.contains(id)) return;  // it is once more in the index
  std::string definition;
  try {
    definition = field(record.data, "message_definition");
  } catch (const BagDamage&) {  // a type that is known here needs none
  }
  index_[id] = add({.topic = std::string(field(record.header, "topic")),
                    .type = std::string(field(record.data, "type")),
                    .definition = std::move(definition),
                    .encoding = RosEncoding::ros1});
}

void Rosbag1Reader::take_chunk(const Record& record) {
  const auto size = number<std::uint32_t>(record.header, "size");
  open_chunk(decompress(field(record.header, "compression"), record.data, size, room()));
}

void Rosbag1Reader::use(const Record& record) {
  switch (number<Op>(record.header, "op")) {
    case Op::chunk:
      return take_chunk(record);
    case Op::connection:
      return connect(record);
    case Op::message: {
      const auto known = index_.find(number<std::uint32_t>(record.header, "conn"));
      if (known == index_.end()) throw BagDamage{"messages of a connection that the bag does not describe"};
      ByteCursor time(field(record.header, "time"));
      const std::int64_t seconds = time.take<std::uint32_t>();
      give({known->second, seconds * kNsPerSecond + time.take<std::uint32_t>(), record.data});
      return;
    }
  }
}

bool Rosbag1Reader::take_record() {
  if (!read_record()) return false;
  use({header_, data_});
  return true;
}

void Rosbag1Reader::take_record_of(ByteCursor& chunk) {
  const std::string_view header = chunk.text();
  const std::string_view data = chunk.text();
  if (number<Op>(header, "op") == Op::chunk) throw BagDamage{"chunks within chunks"};
  use({header, data});
}

}  // namespace crisp::bag
