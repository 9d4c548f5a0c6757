// SPDX-License-Identifier: BSD-3-Clause
// Bags: whatever the bytes are, scans and angles of finite numbers, or counted losses.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include <crisp/error.hpp>

#include "grabbers/bag/bag_items.hpp"
#include "grabbers/bag/bag_summary.hpp"
#include "grabbers/bag/byte_cursor.hpp"
#include "grabbers/bag/mcap_reader.hpp"
#include "grabbers/bag/ros_scan_messages.hpp"
#include "grabbers/bag/rosbag1_reader.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;

void require(bool holds) {
  if (!holds) std::abort();
}

void use(const BagConnection& connection, const BagMessage& message, const Rig& rig, BagItems& items) {
  try {
    if (const auto scans = ScanDecoder::of(connection)) {
      if (const auto scan = items.add(scans->decode(message.data), message.receipt_ns, 0)) {
        require(std::isfinite(scan->start_angle) && std::isfinite(scan->beam_interval));
        for (const auto& echo : scan->echoes) {
          for (const float range : echo.ranges) require(range >= 0 && std::isfinite(range));
        }
      }
    }
    if (const auto angles = AngleDecoder::of(connection, rig.plate)) {
      const auto angle = angles->decode(message.data);
      if (angle) require(std::isfinite(angle->angle));
      if (angle) items.add(*angle, message.receipt_ns);
    }
  } catch (const BagDamage&) {  // is counted
  }
}

template <class Reader>
void read_all(const std::string& bytes) {
  const Rig rig = default_rig();
  std::istringstream in(bytes);
  Reader reader(in);
  BagItems items(rig, 1);
  while (const auto message = reader.next()) {
    require(message->connection < reader.connections().size());
    use(reader.connections()[message->connection], *message, rig, items);
  }
  items.for_each_measured([](const std::shared_ptr<const Measurements>& beams) {
    for (const float range : beams->range) require(range > 0);
  });
  std::istringstream again(bytes);
  Reader second(again);
  to_text(summarize(second));
}

}  // namespace
}  // namespace crisp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  crisp::read_all<crisp::bag::Rosbag1Reader>(bytes);
  crisp::read_all<crisp::bag::McapReader>(bytes);
  return 0;
}
