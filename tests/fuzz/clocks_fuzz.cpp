// SPDX-License-Identifier: BSD-3-Clause
// The clock stages: whatever the order and the stamps of scans and readings, either an Error, or finite
// times, the plate's trajectory before what it places, and each scan either handed out or counted as left
// out.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include <crisp/clock_aligner.hpp>
#include <crisp/error.hpp>

#include "tests/fuzz/item_script.hpp"

namespace crisp {
namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

using MakeAligner = std::function<std::unique_ptr<Aligner>(const Rig& rig, AlignmentSink sink)>;

/// What an aligner hands out, checked.
struct Checked {
  std::uint64_t scans = 0;
  bool has_trajectory = false;

  void take(const Measurements& scan) {
    ++scans;
    require(has_trajectory, "a trajectory comes first");
    for (std::size_t i = 0; i < scan.size(); ++i) {
      require(std::isfinite(scan.time[i]), "times are finite");
      require(scan.range[i] > 0 && std::isfinite(scan.range[i]), "ranges are positive");
      require(scan.laser[i] < 3, "lasers are the rig's");
    }
  }
};

/// Scans that were left out, by any reason.
std::uint64_t left_out(const AlignmentReport& report) {
  std::uint64_t n = 0;
  for (const DeviceReport& device : report.devices) {
    if (device.device != "plate") n += device.left_out();
  }
  for (const auto& [what, count] : report.counts) {
    if (what.ends_with("scans without ranges") || what.starts_with("scans of ")) n += count;
  }
  return n;
}

void align(const ItemSequence& items, const MakeAligner& make) {
  Checked checked;
  const auto aligner =
      make(default_rig(),
           {.trajectory = [&](const PlateTrajectory&) { checked.has_trajectory = true; },
            .measurements = [&](const std::shared_ptr<const Measurements>& scan) { checked.take(*scan); }});
  std::uint64_t scans = 0;
  try {
    for (const auto& item : items) {
      if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
        ++scans;
        aligner->add(*scan);
      } else {
        aligner->add(std::get<PlateReading>(item));
      }
    }
    const AlignmentReport report = aligner->finish();
    for (const DeviceReport& device : report.devices) {
      if (!device.clock) continue;
      require(std::isfinite(device.clock->skew_ppm()), "skews are finite");
      require(std::isfinite(device.clock->to_hub(device.clock->device_end)), "maps are finite");
      require(std::isfinite(device.clock->std_error), "standard errors are finite");
    }
    if (scans != checked.scans + left_out(report)) {
      std::fprintf(stderr, "%lu scans, %lu handed out, %lu left out\n", scans, checked.scans,
                   left_out(report));
    }
    require(scans == checked.scans + left_out(report), "each scan is handed out or counted");
  } catch (const Error& error) {
    require(!error.message().empty(), "an error has a message");
  }
}

MakeAligner batch(const AlignmentSettings& settings) {
  return [=](const Rig& rig, AlignmentSink sink) {
    return std::make_unique<ClockAligner>(rig, settings, std::move(sink));
  };
}

}  // namespace
}  // namespace crisp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace crisp;  // NOLINT(google-build-using-namespace)
  const ItemSequence items = ItemScript({data, size}).items();
  align(items, batch({}));
  align(items, batch({.window = 5, .plate = {.smoothing = 0}}));
  align(items, batch({.source = TimeSource::receipt, .plate = {.smoothing = 0}}));
  align(items, [](const Rig& rig, AlignmentSink sink) {
    return std::make_unique<OnlineAligner>(
        rig, AlignmentSettings{.plate = {.smoothing = 0}, .mirror_half_width = kOnlineMirror},
        OnlineSettings{}, std::move(sink));
  });
  return 0;
}
