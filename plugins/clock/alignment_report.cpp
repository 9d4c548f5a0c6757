// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/data/degree.hpp"
#include "plugins/clock/hub_timings.hpp"

namespace crisp {
namespace {

constexpr double kFar = 1e-3;  // [s] a plate at 1 Hz turns by 0.36° in that time: not to be trusted

void count_losses(const DeviceReport& device, std::map<std::string, std::uint64_t>& counts) {
  const auto count = [&](const char* what, std::uint64_t n) { counts[device.device + ": " + what] = n; };
  count("telegrams lost", device.lost);
  count("repeated telegrams", device.repeated);
  count("telegrams out of order", device.late);
  count("telegrams with the stamp of their predecessor", device.standing);
  count("telegrams with impossible times", device.damaged);
  count("clock resets", device.resets);
  count("silences of a second or more", device.silences.size());
}

void warn_of_steps(const std::string& device, const char* what, const std::vector<StampStep>& steps,
                   std::vector<std::string>& warnings) {
  if (steps.empty()) return;
  const StampStep& largest =
      *std::ranges::max_element(steps, {}, [](const StampStep& step) { return std::abs(step.by); });
  warnings.push_back(fmt::format("{}: {} {} time(s), by {:+.3f} ms at {:.2f} s{}; corrected", device, what,
                                 steps.size(), 1e3 * largest.by, largest.at,
                                 steps.size() > 1 ? ", and less elsewhere" : ""));
}

void warn_of_count_jumps(const std::string& plate, const clock::EncoderTimestamper::CountJumps& jumps,
                         std::vector<std::string>& warnings) {
  if (jumps.by_turns > 0)
    warnings.push_back(fmt::format(
        "{}: its count begins anew after whole turns ({} time(s)), as at an index pulse; later counts are continued from before",
        plate, jumps.by_turns));
  if (jumps.others == 0) return;
  warnings.push_back(fmt::format(
      "{}: its count jumped {} time(s), by {:+.2f} deg at {:.2f} s{}, faster than a plate can turn; corrected, as if the plate had turned on as before. Check whether the encoder slips or loses counts",
      plate, jumps.others, jumps.largest / data::kDegree, jumps.time,
      jumps.others > 1 ? ", and less elsewhere" : ""));
}

void warn_of_device(const DeviceReport& device, std::vector<std::string>& warnings) {
  const std::string& name = device.device;
  if (device.received == 0) {
    warnings.push_back(name + ": no data of it");
    return;
  }
  if (!device.silences.empty()) {
    const auto longest =
        std::max_element(device.silences.begin(), device.silences.end(),
                         [](const SilentTime& a, const SilentTime& b) { return a.duration < b.duration; });
    warnings.push_back(
        fmt::format("{}: silent {} time(s) for a second or more, longest {:.1f} s from {:.1f} s on", name,
                    device.silences.size(), longest->duration, longest->begin));
  }
  if (device.resets > 0) {
    warnings.push_back(fmt::format("{}: its clock was reset {} time(s); each segment has a line of its own",
                                   name, device.resets));
  }
  warn_of_steps(name, "its clock jumped", device.clock_steps, warnings);
  warn_of_steps(name, "its shortest delay changed", device.delay_steps, warnings);
}

std::string about(std::uint64_t n, std::uint64_t all) {
  return fmt::format("{} of {} telegrams ({:.1f} %)", n, all,
                     100 * static_cast<double>(n) / static_cast<double>(all));
}

/// Why telegrams of a device are left out, the commonest reason alone.
std::string reason_of(const DeviceReport& device) {
  constexpr double kStands = 0.25;  // [s] a clock that ticks more coarsely is of no use either
  if (device.standing >= std::max(device.late, device.damaged)) {
    const std::string same =
        about(device.standing, device.received) + " carry the stamp of their predecessor";
    if (device.standstill < kStands) return "its clock's resolution is too coarse: " + same;
    return fmt::format("its clock stands still (for {:.1f} s): {}", device.standstill, same);
  }
  if (device.late >= device.damaged) {
    return about(device.late, device.received) + " are out of order, by their stamps";
  }
  return about(device.damaged, device.received) + " have times inconsistent with those before and after";
}

/// Reports a device of which more than a few telegrams are left out: a caveat where hardly any is usable.
/// Repeated telegrams are no loss.
void report_losses(const DeviceReport& device, AlignmentReport& report) {
  constexpr double kFew = 0.03;
  constexpr double kNearlyAll = 0.95;
  const auto lost = static_cast<double>(device.late + device.standing + device.damaged);
  const double share =
      lost / static_cast<double>(std::max<std::uint64_t>(1, device.received - device.repeated));
  if (device.by_receipt) {
    report.caveats.push_back(fmt::format(
        "{}: its clock stands still; {} of {} telegrams are placed by their receipt. Their delays are unknown and become part of eta, which is off by more than its standard error: use this calibration for recordings of the same kind only, or switch on the device's time stamps",
        device.device, device.received - device.left_out(), device.received));
    return;
  }
  if (share <= kFew) return;
  (share < kNearlyAll ? report.warnings : report.caveats)
      .push_back(fmt::format(
          "{}: {}; they are left out. {}", device.device, reason_of(device),
          device.standing > 0
              ? "Switch on its time stamps or update its firmware; clock.receipt places by receipt times instead"
              : "Check the device and the order of the recording"));
}

/// A line that is as steep as any may be fits stamps that have no clock in common. Few stamps, or close ones,
/// can make it steep by chance; but then they are not far from it.
std::string caveat_of(const DeviceReport& device) {
  if (!device.clock || device.clock->residual_median < kFar) return {};
  if (std::abs(device.clock->skew_ppm()) < 0.99e6 * clocks::kMaxSkew) return {};
  return fmt::format(
      "{}: its stamps fit no clock of constant rate (skew beyond {:.0f} ppm; half of them more than {:.1f} ms from it)",
      device.device, 1e6 * clocks::kMaxSkew, 1e3 * device.clock->residual_median);
}

/// Uncertainty of a clock's line [s] at the ends of half a minute about its middle; a longer recording has
/// more than one line. Where the minimum delay or the device's time stepped, or hardly any telegram came
/// without delay, few stamps are near the line, and they alone determine its slope.
double error_of_clock(const ClockMap& clock) {
  constexpr double kLong = 30;  // [s]
  const double span = clock.device_end - clock.pieces.front().device_begin;
  return clock.skew_std_error * std::min(kLong, 0.5 * span);
}

/// Reports a poorly determined clock: as a caveat, or only as a warning.
void report_error_of_clock(const ClockMap& clock, AlignmentReport& report) {
  constexpr double kMuch = 0.25e-3;  // [s] a plate at 1 Hz turns by 0.09° in that time
  const double error = error_of_clock(clock);
  if (error < kMuch) return;
  (error < kFar ? report.warnings : report.caveats)
      .push_back(fmt::format(
          "{}: its clock is determined to {:.1f} ms only ({:.0f} ± {:.0f} ppm): too few telegrams came without delay, or the delay or its time stepped, which diagnose.clocks detects",
          clock.device, 1e3 * error, clock.skew_ppm(), 1e6 * clock.skew_std_error));
}

}  // namespace

void AlignmentReport::append(AlignmentReport other) {
  devices.insert(devices.end(), other.devices.begin(), other.devices.end());
  for (const auto& [what, n] : other.counts) counts[what] += n;
  for (auto& warning : other.warnings) warnings.push_back(std::move(warning));
  hub_steps.insert(hub_steps.end(), other.hub_steps.begin(), other.hub_steps.end());
  hub_deviation = std::max(hub_deviation, other.hub_deviation);
  for (auto& caveat : other.caveats) caveats.push_back(std::move(caveat));
}

}  // namespace crisp

namespace crisp::clock {

AlignmentReport HubTimings::report() const {
  AlignmentReport report{.devices = reports()};
  for (const auto& laser : lasers_) {
    report.counts[laser.laser().name + ": scans without ranges"] = laser.without_ranges();
    report.counts[laser.laser().name + ": beams without echo"] = laser.without_echo();
    report.counts[laser.laser().name + ": beams with a later echo only"] = laser.echoes().later;
    report.counts[laser.laser().name + ": echoes that the rig's choice leaves out"] = laser.echoes().unused;
    if (laser.has_no_echoes())
      report.warnings.push_back(fmt::format(
          "{}: none of its {} beams has an echo: nothing is within its range, its window is covered, or it sends codes in place of ranges",
          laser.laser().name, laser.without_echo()));
    if (auto warning = laser.stamp_warning(); !warning.empty()) report.warnings.push_back(std::move(warning));
  }
  for (const auto& device : report.devices) {
    count_losses(device, report.counts);
    warn_of_device(device, report.warnings);
    report_losses(device, report);
    if (auto caveat = caveat_of(device); !caveat.empty()) report.caveats.push_back(std::move(caveat));
    if (device.clock) report_error_of_clock(*device.clock, report);
  }
  const std::string& plate = report.devices.back().device;
  report.counts[plate + ": readings after its zero was lost"] = plate_.after_lost_zero();
  report.counts[plate + ": readings with an impossible angle"] = plate_.impossible();
  report.counts[plate + ": readings at one hub time"] = plate_.simultaneous();
  report.counts["scans of lasers that the rig does not have"] = unknown_lasers_;
  report.counts["telegrams received before their predecessor"] = back_in_time_;
  warn_of_count_jumps(plate, plate_.count_jumps(), report.warnings);
  if (plate_.after_lost_zero() > 0) {
    report.warnings.push_back(fmt::format(
        "{}: the encoder lost its zero; later readings have an unknown offset and are left out", plate));
  }
  if (back_in_time_ > 0) {
    report.warnings.emplace_back(
        "the hub's clock went back by more than a second: later data are not aligned");
  }
  return report;
}

}  // namespace crisp::clock
