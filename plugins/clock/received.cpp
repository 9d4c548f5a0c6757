// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/received.hpp"

#include <utility>

namespace crisp::clock {
namespace {

const Scan* scan_of(const Received& item) {
  const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
  return scan ? scan->get() : nullptr;
}

}  // namespace

std::int64_t receipt_of(const Received& item) {
  const Scan* scan = scan_of(item);
  return scan ? scan->receipt_ns : std::get<PlateReading>(item).receipt_ns;
}

std::size_t device_of(const Received& item) {
  const Scan* scan = scan_of(item);
  return scan ? std::size_t{1} + scan->laser : 0;
}

clocks::DeviceStamp stamp_of(const Received& item) {
  const Scan* scan = scan_of(item);
  if (scan) return {.receipt_ns = scan->receipt_ns, .device_us = scan->transmission_time_us};
  const auto& reading = std::get<PlateReading>(item);
  return {.receipt_ns = reading.receipt_ns,
          .device_us = reading.device_us + static_cast<std::uint32_t>(reading.handover_us)};
}

void set_back(Received& item, std::int64_t step_ns) {
  if (const Scan* scan = scan_of(item)) {
    auto earlier = std::make_shared<Scan>(*scan);
    earlier->receipt_ns -= step_ns;
    item = std::shared_ptr<const Scan>(std::move(earlier));
  } else {
    std::get<PlateReading>(item).receipt_ns -= step_ns;
  }
}

}  // namespace crisp::clock
