// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "grabbers/bag/byte_cursor.hpp"
#include "grabbers/bag/ros_message_schema.hpp"

namespace crisp::bag {
namespace {

constexpr const char* kTooShort = "messages that end before their content";

template <class T>
T value_at(std::string_view bytes, std::size_t i) {
  T value;
  std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
  return value;
}

/// Calls `use` with the i-th number in its own type.
template <class Use>
auto with_number(RosType type, std::string_view bytes, std::size_t i, Use use) {
  switch (type) {
    case RosType::int8:
      return use(value_at<std::int8_t>(bytes, i));
    case RosType::int16:
      return use(value_at<std::int16_t>(bytes, i));
    case RosType::uint16:
      return use(value_at<std::uint16_t>(bytes, i));
    case RosType::int32:
      return use(value_at<std::int32_t>(bytes, i));
    case RosType::uint32:
      return use(value_at<std::uint32_t>(bytes, i));
    case RosType::int64:
      return use(value_at<std::int64_t>(bytes, i));
    case RosType::uint64:
      return use(value_at<std::uint64_t>(bytes, i));
    case RosType::float32:
      return use(value_at<float>(bytes, i));
    case RosType::float64:
      return use(value_at<double>(bytes, i));
    default:
      return use(value_at<std::uint8_t>(bytes, i));
  }
}

/// Walks through a message field by field.
class Decoder {
 public:
  Decoder(const RosMessageSchema& layout, RosEncoding encoding, std::string_view message)
      : layout_(layout), aligned_(encoding == RosEncoding::cdr), cursor_(message, BagDamage{kTooShort}) {
    constexpr std::size_t kEncapsulation = 4;
    if (!aligned_) return;
    const std::string_view begin = cursor_.bytes(kEncapsulation);
    if (begin[1] != 1) throw BagDamage{"messages that are not in little-endian CDR"};
    length_ = cursor_.size();
  }

  std::vector<RosValue> decode() {
    read_parts(layout_.fields.front());
    return std::move(values_);
  }

 private:
  void read_parts(const RosField& message) {
    for (const std::size_t part : message.parts) read(part);
  }

  /// Numbers begin where their size divides the distance from the message's begin.
  void align(std::size_t size) {
    if (!aligned_ || size < 2) return;
    const std::size_t at = length_ - cursor_.size();
    cursor_.bytes((size - at % size) % size);
  }

  std::uint32_t length() {
    align(sizeof(std::uint32_t));
    return cursor_.take<std::uint32_t>();
  }

  void read(std::size_t index) {
    const RosField& field = layout_.fields[index];
    const std::uint64_t n = field.count == RosCount::counted ? length() : field.fixed;
    if (const std::size_t size = size_of(field.type); size > 0) {
      if (n > 0) align(size);
      return values_.push_back({index, n, cursor_.bytes(n * size)});
    }
    // Each takes a byte at least: a damaged number of them ends here.
    if (n > cursor_.size()) throw BagDamage{kTooShort};
    for (std::uint64_t i = 0; i < n; ++i) {
      if (field.type == RosType::message) {
        read_parts(field);
      } else {
        read_text(index);
      }
    }
  }

  void read_text(std::size_t index) {
    std::string_view text = cursor_.bytes(length());
    if (aligned_ && text.ends_with('\0')) text.remove_suffix(1);
    values_.push_back({index, 1, text});
  }

  const RosMessageSchema& layout_;
  bool aligned_;
  ByteCursor cursor_;
  std::size_t length_ = 0;  ///< [bytes] of the message behind its encapsulation
  std::vector<RosValue> values_;
};

}  // namespace

double RosValue::number(RosType type, std::size_t i) const {
  return with_number(type, bytes, i, [](auto value) { return static_cast<double>(value); });
}

std::int64_t RosValue::integer(RosType type) const {
  return with_number(type, bytes, 0, [](auto value) -> std::int64_t {
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      constexpr double kLargest = 9e18;
      return std::abs(static_cast<double>(value)) < kLargest ? std::llround(static_cast<double>(value)) : 0;
    } else {
      return static_cast<std::int64_t>(value);
    }
  });
}

std::vector<RosValue> decode_ros(const RosMessageSchema& layout, RosEncoding encoding,
                                 std::string_view message) {
  if (encoding == RosEncoding::other) throw BagDamage{"messages in an unknown encoding"};
  return Decoder(layout, encoding, message).decode();
}

}  // namespace crisp::bag
