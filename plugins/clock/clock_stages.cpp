// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/clock_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crisp::clock {
namespace {

constexpr double kPpmPerHour = 1e-6 / 3600;  // [1/s]

nlohmann::json to_json(const std::vector<StampStep>& steps) {
  auto list = nlohmann::json::array();
  for (const StampStep& step : steps) list.push_back({{"at", step.at}, {"by", step.by}});
  return list;
}

nlohmann::json to_json(const DeviceReport& device) {
  auto silences = nlohmann::json::array();
  for (const auto& silence : device.silences) {
    silences.push_back({{"begin", silence.begin}, {"duration", silence.duration}});
  }
  const auto of_clock = [&](auto value) {
    return device.clock ? nlohmann::json(value(*device.clock)) : nlohmann::json();
  };
  return {{"device", device.device},
          {"received", device.received},
          {"stamps", device.stamps},
          {"skew_ppm", of_clock([](const ClockMap& clock) { return clock.skew_ppm(); })},
          {"skew_std_error_ppm", of_clock([](const ClockMap& clock) { return 1e6 * clock.skew_std_error; })},
          {"delay_median", of_clock([](const ClockMap& clock) { return clock.residual_median; })},
          {"delay_95", of_clock([](const ClockMap& clock) { return clock.residual_95; })},
          {"lines", device.clock ? device.clock->pieces.size() : 0},
          {"lost", device.lost},
          {"repeated", device.repeated},
          {"late", device.late},
          {"standing", device.standing},
          {"damaged", device.damaged},
          {"resets", device.resets},
          {"silences", silences},
          {"clock_steps", to_json(device.clock_steps)},
          {"delay_steps", to_json(device.delay_steps)}};
}

std::string table_of(const std::vector<DeviceReport>& devices) {
  std::string text = fmt::format("{:10} {:>9} {:>9} {:>8} {:>11} {:>11} {:>6} {:>6}", "device", "stamps",
                                 "skew/ppm", "+-", "median/us", "95 %/us", "lost", "resets");
  const auto recordings =
      std::ranges::count(devices, devices.front().device, [](const auto& device) { return device.device; });
  int recording = 0;
  for (const auto& device : devices) {
    if (recordings > 1 && device.device == devices.front().device) {
      text += fmt::format("\nrecording {} of {}", ++recording, recordings);
    }
    if (!device.clock) {
      text += fmt::format("\n{:10} {:>9}", device.device, 0);
      continue;
    }
    const ClockMap& clock = *device.clock;
    text += fmt::format("\n{:10} {:>9} {:>9.3f} {:>8.3f} {:>11.1f} {:>11.1f} {:>6} {:>6}", clock.device,
                        clock.stamps, clock.skew_ppm(), 1e6 * clock.skew_std_error,
                        1e6 * clock.residual_median, 1e6 * clock.residual_95, device.lost, device.resets);
  }
  return text;
}

/// The map with the delays that receipts keep, and a lag takes up, in its standard error.
ClockMap with_delays(ClockMap clock) {
  clock.std_error = std::hypot(clock.std_error, clock.residual_median);
  return clock;
}

}  // namespace

template <class S>
void AlignStage::describe_alignment(StageDescription<S>& d) {
  d.template takes<Scan>().template takes<PlateReading>();
  d.template gives<PlateTrajectory>().template gives<Measurements>().template gives<ClockMap>();
  d.option("max_gap", &AlignStage::settings_, &AlignmentSettings::plate, &PlateMotionSettings::max_gap,
           "longest silence of the encoder to interpolate across")
      .unit("s")
      .range(1e-4, 10);
  d.option(
       "plate_smoothing", &AlignStage::settings_, &AlignmentSettings::plate, &PlateMotionSettings::smoothing,
       "half width of the window over which readings are smoothed between the steps of the encoder; where the plate is shaken, a half or a quarter of it is used. No angle is moved by more than 0.6 steps. 0: readings as they are")
      .unit("s")
      .range(0, 1);
  d.option("mirror_smoothing", &AlignStage::settings_, &AlignmentSettings::mirror_half_width,
           "scans on either side that smooth the motion of a mirror; auto: chosen by cross-validation")
      .range(1, 10);
}

template <class S>
void AlignStage::describe_windows(StageDescription<S>& d) {
  d.option(
       "window", &AlignStage::settings_, &AlignmentSettings::window,
       "duration of stamps to which one line is fitted; less than 1.5 of it have one line; auto: 60 s, and up to 240 s where delays are irregular")
      .unit("s")
      .range(1, 3600);
  d.option("margin", &AlignStage::settings_, &AlignmentSettings::margin,
           "margin by which a piece of the plate's trajectory exceeds its measurements' times")
      .unit("s")
      .range(0, 10);
}

template <class S>
void AlignStage::describe_fit(StageDescription<S>& d) {
  d.option(
       "drift", &AlignStage::drift_,
       "largest change of a clock's rate, in ppm in an hour; increase it for a device that warms up quickly")
      .unit("ppm/h")
      .range(0, 1e5);
}

void ConvexHullStage::describe(StageDescription<ConvexHullStage>& d) {
  d.name("clock.convex_hull")
      .summary("transforms all stamps to the hub's clock, by the convex hull below them");
  d.details(
      "Telegrams are delayed, never early: the device's clock is the highest line below all pairs of transmission and receipt time, an edge of their lower convex hull (Zhang, Liu, Xia 2002). Long recordings have a line per window, and the map is linear between the windows' centres, so that it follows a clock's drift. A reset of a device begins a new line. After a pause of 5 s without items from any device another recording begins, independent of the one before it.\n\n"
      "Each beam gets its firing time: the mirror's motion is estimated from the scans' own stamps, since mirrors turn up to 0.6 % slower than nominal, and wander.\n\n"
      "Prints for each device: its stamps; its clock's skew and the standard error (`+-`), in ppm, above zero where the clock is slower than the hub's; median and 95 % quantile of the delays beyond the shortest, in microseconds (`median/us`, `95 %/us`; below a millisecond is good); lost telegrams and resets of the clock.");
  describe_alignment(d);
  describe_windows(d);
  describe_fit(d);
}

void OnlineStage::describe(StageDescription<OnlineStage>& d) {
  d.name("clock.online").summary("transforms stamps to the hub's clock as they arrive, with bounded delay");
  d.details(
      "For live pipelines: each scan is passed on, with its piece of the plate's trajectory, as soon as encoder readings cover it. A device's clock is the line of clock.convex_hull for its stamps of the last `window`; scans passed on are not corrected later. After a restart of a device its clock is a new one, and its scans wait for `warm_up`. The mirror's motion is estimated from the stamps so far.\n\n"
      "The output depends on the items and their times of receipt alone: from a recording of a live run the same stage makes the same measurements. With a calibration from above, the stage waits for the readings that its lags require.");
  describe_alignment(d);
  d.holds<Calibration>(Need::optional);
  d.option("window", &OnlineStage::online_, &OnlineSettings::window,
           "duration of stamps to which a clock's line is fitted")
      .unit("s")
      .range(1, 3600);
  d.option("warm_up", &OnlineStage::online_, &OnlineSettings::warm_up,
           "duration of a device's stamps before its clock is used")
      .unit("s")
      .range(0, 60);
  d.option(
       "margin", &OnlineStage::online_, &OnlineSettings::margin,
       "margin by which a piece of the plate's trajectory exceeds its scan, as far as it has been received")
      .unit("s")
      .range(0, 1);
  d.option(
       "lag_margin", &OnlineStage::online_, &OnlineSettings::lag_margin,
       "margin for lags beyond the calibration from above, where calibrate.watch below estimates them again")
      .unit("s")
      .range(0, 0.1);
  d.option("plate_timeout", &OnlineStage::online_, &OnlineSettings::plate_timeout,
           "timeout for encoder readings, after which a scan is passed on without them")
      .unit("s")
      .range(0, 60);
  describe_fit(d);
}

std::unique_ptr<Aligner> OnlineStage::make_aligner(const Rig& rig, AlignmentSink sink) const {
  return std::make_unique<OnlineAligner>(rig, settings_, online_, std::move(sink));
}

void OnlineStage::take_lags(const std::shared_ptr<const Calibration>& calibration) {
  if (!calibration || calibration == calibration_) return;
  calibration_ = calibration;
  online_ = with_lags(online_, *calibration);
  if (aligner_) static_cast<OnlineAligner&>(*aligner_).set_lags(*calibration);
}

void OnlineStage::process(const Inputs& in, Outputs& out, Context& context) {
  take_lags(in.share<Calibration>());
  AlignStage::process(in, out, context);
  if (context.is_watched()) report(context);
}

void OnlineStage::report(Context& context) {
  constexpr double kReportEvery = 0.5;  // [s]
  const auto& aligner = static_cast<const OnlineAligner&>(*aligner_);
  if (!reported_) reported_ = aligner.now();  // the first stamps do not determine a skew
  if (aligner.now() - *reported_ < kReportEvery) return;
  reported_ = aligner.now();
  StageStatus status{.line = "skew"};
  for (const DeviceReport& device : aligner.devices()) {
    const double skew = device.clock ? 1e6 * (device.clock->pieces.back().rate - 1) : 0;
    status.line += fmt::format(" {:+.1f}", skew);
    status.gauges.push_back({"clock_skew_ppm", skew, device.device});
    status.gauges.push_back({"clock_resets_total", static_cast<double>(device.resets), device.device});
  }
  status.line += fmt::format(" ppm, {} scans wait for the plate", aligner.waiting());
  status.gauges.push_back({"scans_waiting", static_cast<double>(aligner.waiting())});
  context.set_status(status);
}

void ReceiptStage::describe(StageDescription<ReceiptStage>& d) {
  d.name("clock.receipt").summary("uses the hub's receipt times, delays included (baseline)");
  d.details(
      "The baseline for comparisons: each scan is placed by the receipt of its telegram, less the time from its stamp to its transmission, and each encoder reading by its receipt. Clocks are fitted only to report the delays that are neglected here. They become part of eta: their median counts in its standard error, and a clock that stands still, whose delays are unknown, makes the result untrusted.");
  describe_alignment(d);
  describe_windows(d);
}

std::unique_ptr<Aligner> AlignStage::make_aligner(const Rig& rig, AlignmentSink sink) const {
  return std::make_unique<ClockAligner>(rig, settings_, std::move(sink));
}

void AlignStage::process(const Inputs& in, Outputs& out, Context& context) {
  out_ = &out;
  if (!aligner_) {
    settings_.drift = drift_ * kPpmPerHour;
    aligner_ = make_aligner(
        context.rig(),
        {.trajectory = [this](PlateTrajectory plate) { out_->give(std::move(plate)); },
         .measurements = [this](std::shared_ptr<const Measurements> scan) { out_->give(std::move(scan)); }});
  }
  if (auto scan = in.share<Scan>()) aligner_->add(std::move(scan));
  if (const auto* reading = in.find<PlateReading>()) aligner_->add(*reading);
}

void AlignStage::finish(Outputs& out, Context& context) {
  out_ = &out;
  if (!aligner_)
    throw Error("nothing was received: no scan, no encoder reading", "check the rig's addresses");
  const AlignmentReport report = aligner_->finish();
  auto devices = nlohmann::json::array();
  for (const auto& device : report.devices) devices.push_back(to_json(device));
  for (const auto& [what, n] : report.counts) context.count(what, n);
  for (const auto& warning : report.warnings) context.warn(warning);
  for (const auto& caveat : report.caveats) context.mark_untrusted(caveat);
  context.report(
      {{"devices", devices},
       {"hub_clock", {{"deviation", report.hub_deviation}, {"steps", to_json(report.hub_steps)}}}});
  context.print(table_of(report.devices));
  for (const auto& device : report.devices) {
    if (device.clock)
      out.give(settings_.source == TimeSource::receipt ? with_delays(*device.clock) : *device.clock);
  }
}

}  // namespace crisp::clock
