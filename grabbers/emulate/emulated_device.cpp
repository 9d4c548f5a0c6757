// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/emulate/emulated_device.hpp"

#include <algorithm>

namespace crisp::emulate {
namespace {

using wire::ChannelBlock;

/// Leaves of a channel the values between two angles, which devices give somewhat roundly.
void crop(ChannelBlock& channel, const wire::OutputRange& range) {
  const std::int64_t slack = channel.angle_step / 2;
  const auto inside = [&](std::size_t k) {
    const auto angle = channel.start_angle + static_cast<std::int64_t>(k) * channel.angle_step;
    return angle >= range.first - slack && angle <= range.last + slack;
  };
  std::size_t first = 0;
  while (first < channel.raw.size() && !inside(first)) ++first;
  std::size_t end = first;
  while (end < channel.raw.size() && inside(end)) ++end;
  channel.start_angle += static_cast<std::int32_t>(first * channel.angle_step);
  channel.raw = {channel.raw.begin() + static_cast<std::ptrdiff_t>(first),
                 channel.raw.begin() + static_cast<std::ptrdiff_t>(end)};
}

/// Leaves one of every so many values.
void thin(ChannelBlock& channel, std::uint32_t every) {
  if (every < 2) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < channel.raw.size(); k += every) channel.raw[kept++] = channel.raw[k];
  channel.raw.resize(kept);
  channel.angle_step = static_cast<std::uint16_t>(channel.angle_step * every);
}

bool is_remission(const ChannelBlock& channel) { return channel.name.starts_with("RSSI"); }

/// Moves remissions to the other width; their values stay, but for what 8 bits cannot hold.
void widen_remissions(wire::ScanData& scan, bool wide) {
  constexpr std::uint16_t kStep = 256;
  auto& from = wide ? scan.channels8 : scan.channels16;
  auto& to = wide ? scan.channels16 : scan.channels8;
  for (ChannelBlock& channel : from) {
    if (!is_remission(channel)) continue;
    channel.scale = wide ? channel.scale / kStep : channel.scale * kStep;
    for (auto& raw : channel.raw) raw = static_cast<std::uint16_t>(wide ? raw * kStep : raw / kStep);
    to.push_back(channel);
  }
  std::erase_if(from, is_remission);
}

/// The calendar clock of a device before it is set: it starts at 1970, in whole milliseconds.
wire::TimeBlock since_start(std::uint32_t scan_time_us) {
  constexpr std::uint32_t kMs = 1000, kSecond = 1000 * kMs, kMinute = 60 * kSecond, kHour = 60 * kMinute;
  return {.hour = static_cast<std::uint8_t>(scan_time_us / kHour),
          .minute = static_cast<std::uint8_t>(scan_time_us / kMinute % 60),
          .second = static_cast<std::uint8_t>(scan_time_us / kSecond % 60),
          .microsecond = scan_time_us % kSecond / kMs * kMs};
}

}  // namespace

wire::ScanSettings EmulatedDevice::settings() const {
  wire::ScanSettings settings{.frequency = last.scan_frequency};
  if (last.channels16.empty() || last.channels16.front().raw.empty()) return settings;
  const ChannelBlock& channel = last.channels16.front();
  settings.resolution = channel.angle_step * every_beam;
  settings.first = channel.start_angle;
  settings.last = channel.start_angle +
                  static_cast<std::int32_t>((channel.raw.size() - 1) / every_beam * settings.resolution);
  return settings;
}

wire::OutputRange EmulatedDevice::output_range() const {
  const wire::ScanSettings own = settings();
  return range.value_or(wire::OutputRange{own.resolution, own.first, own.last});
}

wire::ScanContent EmulatedDevice::content() const {
  if (configured) return *configured;
  const bool wide = std::ranges::any_of(last.channels16, is_remission);
  return {.remission = wide || std::ranges::any_of(last.channels8, is_remission),
          .wide = wide,
          .encoders = static_cast<std::uint16_t>(last.encoders.empty() ? 0 : 1),
          .time = last.time.has_value()};
}

bool EmulatedDevice::set_resolution(std::uint32_t resolution) {
  const std::uint32_t own = settings().resolution / every_beam;
  if (resolution == 0 || resolution % own != 0) return false;
  every_beam = resolution / own;
  return true;
}

bool EmulatedDevice::sends(const wire::ScanData& scan) const {
  return !configured || configured->interval < 2 || scan.scan_counter % configured->interval == 0;
}

wire::ScanData EmulatedDevice::sent(wire::ScanData scan) const {
  const wire::ScanContent content = this->content();
  if (!content.remission) {
    std::erase_if(scan.channels16, is_remission);
    std::erase_if(scan.channels8, is_remission);
  }
  if (configured) {
    widen_remissions(scan, content.wide);
    if (content.encoders == 0) scan.encoders.clear();
    scan.time = content.time ? std::optional(since_start(scan.scan_time_us)) : std::nullopt;
  }
  for (auto* channels : {&scan.channels16, &scan.channels8}) {
    for (ChannelBlock& channel : *channels) {
      thin(channel, every_beam);
      if (range) crop(channel, *range);
    }
  }
  return scan;
}

}  // namespace crisp::emulate
