// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/loss_warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "grabbers/capture/capture_report.hpp"
#include "grabbers/capture/packet.hpp"
#include "pipeline/data/counted.hpp"

namespace crisp::capture {
namespace {

constexpr double kTolerable = 0.01;  // share of losses below which there is no warning
constexpr double kNearlyAll = 0.95;  // with so much lost, a laser is lost

double share(std::uint64_t lost, std::uint64_t all) {
  return all == 0 ? 0 : static_cast<double>(lost) / static_cast<double>(all);
}

/// Warning of unreadable scan telegrams of a laser, if their share is between these
/// limits.
std::string unreadable(const DeviceStatistics& device, double above, double up_to) {
  const auto all = device.items + device.unreadable;
  const double part = share(device.unreadable, all);
  if (device.name.empty() || part <= above || part > up_to) return {};
  std::string_view why;
  std::uint64_t most = 0;
  for (const auto& [what, n] : device.losses.all()) {
    if (!what.starts_with("scan telegrams that ") || n <= most) continue;
    why = what;
    most = n;
  }
  return fmt::format(
      "{:.1f} % of the scans of {} ({} of {}) are unusable: {} {}. Configure the same output format for all of its channels",
      100 * part, title(device), device.unreadable, all, most, why);
}

}  // namespace

std::string truncated_packets(const CaptureStatistics& statistics) {
  return fmt::format(
      "{} of {} are cut off by the recording's snap length, and what they carried is lost: record whole packets (tcpdump -s 0)",
      statistics.truncated, data::counted(statistics.packets, "packet"));
}

std::vector<std::string> loss_warnings(const CaptureStatistics& statistics, const std::string& source) {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& what) {
    warnings.push_back(source.empty() ? what : source + ": " + what);
  };
  for (const auto& remark : statistics.remarks) warn(remark);
  if (statistics.truncated > 0) warn(truncated_packets(statistics));
  if (const auto cut_off = statistics.losses.of(file_loss::kCutOff); cut_off > 0) {
    warn(fmt::format("the file ends {} bytes into a record: the recording or the copy was truncated",
                     cut_off));
  }
  const auto skipped = statistics.losses.of(file_loss::kSkippedBytes);
  if (const auto part = share(skipped, statistics.file_bytes); part > kTolerable) {
    warn(fmt::format("{:.1f} % of the file ({} bytes) are damaged and were skipped; use an intact copy",
                     100 * part, skipped));
  }
  for (const auto& device : statistics.devices) {
    if (auto what = unreadable(device, kTolerable, kNearlyAll); !what.empty()) warn(what);
    const auto lost = never_came(device);
    const auto sent = device.items + lost;
    if (device.name.empty() || share(lost, sent) <= kTolerable) continue;
    const bool laser = device.kind == DeviceKind::Laser;
    warn(fmt::format(
        "{:.1f} % of the telegrams of {} ({} of {} {}) were lost, by its own count: check the cable, the switch and the hub's load, or use a complete copy",
        100 * share(lost, sent), title(device), lost, sent, laser ? "scans" : "readings"));
  }
  return warnings;
}

std::vector<std::string> lost_devices(const CaptureStatistics& statistics) {
  std::vector<std::string> caveats;
  for (const auto& device : statistics.devices) {
    if (auto what = unreadable(device, kNearlyAll, 1); !what.empty()) caveats.push_back(std::move(what));
  }
  return caveats;
}

std::vector<std::string> address_conflicts(const CaptureStatistics& statistics) {
  std::vector<std::string> caveats;
  for (const auto& device : statistics.devices) {
    if (device.name.empty() || device.serial_changes < 2) continue;
    caveats.push_back(fmt::format(
        "{}: {} units (serial numbers {}) send by turns from {}, so its scans are of several lasers. Give each unit an address of its own",
        device.name, device.serial_numbers.size(), fmt::join(device.serial_numbers, ", "),
        device.address.ip));
  }
  return caveats;
}

}  // namespace crisp::capture
