// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <numbers>

#include "grabbers/capture/loss_warnings.hpp"
#include "pipeline/data/counted.hpp"
#include "pipeline/data/recordings.hpp"

namespace crisp::capture {
namespace {

constexpr double kNanosecond = 1e-9;

double seconds(std::int64_t ns) { return kNanosecond * static_cast<double>(ns); }

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

nlohmann::json to_json(const Counts& counts) {
  auto object = nlohmann::json::object();
  for (const auto& [name, n] : counts.all()) object[name] = n;
  return object;
}

nlohmann::json to_json(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json to_json(const DeviceStatistics& device) {
  const bool laser = device.kind == DeviceKind::Laser;
  nlohmann::json object = {{"kind", laser ? "laser" : "plate"},
                           {"name", device.name},
                           {"ip", device.address.ip},
                           {"port", device.address.port},
                           {"items", device.items},
                           {"rate", device.rate()},
                           {"telegrams", to_json(device.telegrams)},
                           {"standing", device.standing},
                           {"losses", to_json(device.losses)},
                           {"notes", to_json(device.notes)},
                           {"first", seconds(device.first_ns)},
                           {"last", seconds(device.last_ns)},
                           {"skew_ppm", device.skew ? nlohmann::json(1e6 * *device.skew) : nlohmann::json()},
                           {"longest_silence", device.longest_silence},
                           {"longest_silence_begin", seconds(device.silence_ns)}};
  if (!laser || device.shape.encoder) {
    object["counted_up"] = device.counted_up;
    object["counted_down"] = device.counted_down;
  }
  if (!laser) return object;
  object["serial_numbers"] = device.serial_numbers;
  object["handover_median"] = to_json(device.median_handover);
  object["period_median"] = to_json(device.period);
  object["period_hint"] = device.period_hint();
  object["nominal_frequency"] = device.nominal_frequency;
  const auto& shape = device.shape;
  object["scan"] = {{"beams", shape.beams},           {"start_angle", shape.start_angle},
                    {"angle_step", shape.angle_step}, {"echoes", shape.echoes},
                    {"remissions", shape.remissions}, {"encoder", shape.encoder}};
  return object;
}

std::string describe(const ScanShape& shape) {
  if (shape.beams == 0) return "";
  auto text = fmt::format("{} beams from {:.4g} by {:.4g} deg", shape.beams, degrees(shape.start_angle),
                          degrees(shape.angle_step));
  if (shape.echoes > 1) text += fmt::format(", {} echoes", shape.echoes);
  if (shape.remissions) text += ", remission";
  if (shape.encoder) text += ", encoder";
  return text;
}

std::string list(std::string_view what, const Counts& counts) {
  std::string text;
  for (const auto& [name, n] : counts.all()) text += fmt::format("\n    {:>9} {}", n, name);
  return text.empty() ? text : fmt::format("\n  {}:{}", what, text);
}

std::string details(const DeviceStatistics& device) {
  auto text = "\n" + title(device);
  for (const auto number : device.serial_numbers) text += fmt::format(", serial number {}", number);
  if (device.skew)
    text += fmt::format("\n  clock: {:+.1f} ppm against the hub's (rough estimate)", 1e6 * *device.skew);
  if (2 * device.standing > device.items) {
    text += fmt::format("\n  clock: stands still: {} of {} items carry the stamp of their predecessor",
                        device.standing, device.items);
  }
  const bool has_encoder = device.kind == DeviceKind::Plate || device.shape.encoder;
  if (has_encoder && device.items > 0) {
    const bool stands = device.counted_up + device.counted_down == 0;
    text += fmt::format("\n  encoder: counted {} up and {} down{}", device.counted_up, device.counted_down,
                        stands ? ": the plate or the encoder stood still" : "");
  }
  if (device.period) {
    text += fmt::format("\n  mirror: {:.3f} ms a turn ({:.2f} Hz, {:.2f} Hz claimed)", 1e3 * *device.period,
                        1 / *device.period, device.nominal_frequency);
  }
  if (device.median_handover) {
    text += fmt::format("\n  a scan is sent {:.2f} ms after its stamp", 1e3 * *device.median_handover);
  }
  if (device.period_hint() != 0) {
    text += ", before its end: the stamp is probably a turn late (period_offset: -1 in the rig)";
  }
  return text + list("telegrams", device.telegrams) + list("lost", device.losses) +
         list("noted", device.notes);
}

}  // namespace

std::string title(const DeviceStatistics& device) {
  const auto address = device.address.port == 0
                           ? device.address.ip
                           : fmt::format("{}:{}", device.address.ip, device.address.port);
  if (!device.name.empty()) return fmt::format("{} ({})", device.name, address);
  return fmt::format("{} at {}", device.kind == DeviceKind::Laser ? "laser" : "plate", address);
}

std::uint64_t never_came(const DeviceStatistics& device) {
  return device.losses.of(device.kind == DeviceKind::Laser ? kTelegramsNeverCame : kReadingsNeverCame);
}

nlohmann::json to_json(const CaptureStatistics& statistics) {
  auto devices = nlohmann::json::array();
  for (const auto& device : statistics.devices) devices.push_back(to_json(device));
  return {{"packets", statistics.packets},
          {"bytes", statistics.bytes},
          {"file_bytes", statistics.file_bytes},
          {"truncated_packets", statistics.truncated},
          {"first", seconds(statistics.first_ns)},
          {"last", seconds(statistics.last_ns)},
          {"duration", seconds(statistics.last_ns - statistics.first_ns)},
          {"pauses", statistics.pauses},
          {"paused", statistics.paused},
          {"link_types", to_json(statistics.link_types)},
          {"losses", to_json(statistics.losses)},
          {"notes", to_json(statistics.notes)},
          {"remarks", statistics.remarks},
          {"devices", devices}};
}

std::string device_table(const CaptureStatistics& statistics) {
  auto text = fmt::format("{:<30} {:>9} {:>9} {:>7} {:>10}  {}", "device", "items", "rate/Hz", "lost",
                          "silence/s", "scans");
  for (const auto& device : statistics.devices) {
    const std::string silence = device.items > 0 ? fmt::format("{:.3f}", device.longest_silence) : "-";
    text += fmt::format("\n{:<30} {:>9} {:>9.3f} {:>7} {:>10}  {}", title(device), device.items,
                        device.rate(), never_came(device), silence, describe(device.shape));
  }
  return text;
}

std::string extent_of(const CaptureStatistics& statistics) {
  auto text = fmt::format("{}, {:.1f} MB", data::counted(statistics.packets, "packet"),
                          1e-6 * static_cast<double>(statistics.bytes));
  if (statistics.packets == 0) return text;
  const auto first = static_cast<std::time_t>(statistics.first_ns / 1'000'000'000);
  return text + fmt::format(", {:.3f} s from {:%Y-%m-%d %H:%M:%S} UTC",
                            seconds(statistics.last_ns - statistics.first_ns), fmt::gmtime(first));
}

std::string to_text(const CaptureStatistics& statistics) {
  std::string text = extent_of(statistics);
  for (const auto& [link_type, n] : statistics.link_types.all()) text += fmt::format(", {}", link_type);
  for (const auto& remark : statistics.remarks) text += "\n  " + remark;
  if (statistics.truncated > 0) text += "\n  " + truncated_packets(statistics);
  if (statistics.pauses > 0) {
    text += fmt::format(
        "\n  {} recordings in sequence, with {:.1f} s of pauses in all between them (of {:.0f} s and more, which are no losses; a forward step of the hub's clock looks like a pause)",
        statistics.pauses + 1, statistics.paused, data::kPause);
  }
  text += list("lost", statistics.losses) + list("noted", statistics.notes);
  if (statistics.devices.empty()) return text + "\nit holds no laser and no plate";
  text += "\n\n" + device_table(statistics) + "\n";
  for (const auto& device : statistics.devices) text += details(device);
  return text;
}

}  // namespace crisp::capture
