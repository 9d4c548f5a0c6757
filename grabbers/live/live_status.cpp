// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/live_status.hpp"

#include <fmt/format.h>

#include <utility>

#include "grabbers/capture/capture_report.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::live {

std::uint64_t lost_items(const CaptureStatistics& statistics) {
  std::uint64_t lost = 0;
  for (const auto& [what, n] : statistics.losses.all()) lost += n;
  // a device's other losses are of bytes and telegrams of the same items
  for (const auto& device : statistics.devices) lost += capture::never_came(device);
  return lost;
}

void LiveStatus::note(const std::string& device, const Counts& counts, double now,
                      std::vector<std::string>& events) {
  constexpr double kNotAgainFor = 10;  // [s]
  for (const auto& [what, n] : counts.all()) {
    const std::string name = device.empty() ? what : fmt::format("{}: {}", device, what);
    const auto [known, fresh] = events_.try_emplace(name);
    Event& event = known->second;
    if (n == event.reported || (!fresh && now < event.again)) continue;
    events.push_back(fmt::format("{} ({})", name, n - event.reported));
    event = {.reported = n, .again = now + kNotAgainFor};
  }
}

StageStatus LiveStatus::report(const CaptureStatistics& statistics, double now, std::size_t waiting,
                               const std::string& running) {
  StageStatus status{.line = running};
  const double elapsed = requested_ ? now - *requested_ : 0;
  for (const auto& device : statistics.devices) {
    const std::uint64_t before = std::exchange(items_[device.name], device.items);
    const double rate = elapsed > 0 ? static_cast<double>(device.items - before) / elapsed : 0;
    status.line += fmt::format("{}{} {:.1f} Hz", status.line.empty() ? "" : ", ", device.name, rate);
    status.gauges.push_back({"items_total", static_cast<double>(device.items), device.name});
    status.gauges.push_back(
        {"items_lost_total", static_cast<double>(capture::never_came(device)), device.name});
    status.gauges.push_back({"rate_hertz", rate, device.name});
    note(device.name, device.losses, now, status.events);
    note(device.name, device.notes, now, status.events);
  }
  note("", statistics.losses, now, status.events);
  requested_ = now;
  const double latency = latencies_.empty() ? 0 : statistics::quantile_in_place(latencies_, 0.99);
  latencies_.clear();
  const std::uint64_t lost = lost_items(statistics);
  status.line += fmt::format(", lost {}, queue {}, latency {:.1f} ms", lost, waiting, 1e3 * latency);
  status.gauges.push_back({"lost_total", static_cast<double>(lost)});
  status.gauges.push_back({"queue_items", static_cast<double>(waiting)});
  status.gauges.push_back({"latency_seconds", latency});
  return status;
}

}  // namespace crisp::live
