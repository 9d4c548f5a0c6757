// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/clock_stages.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace crisp {
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

}  // namespace

template <class S>
void AlignStage::describe_alignment(StageDescription<S>& d) {
  d.template takes<Scan>().template takes<PlateReading>();
  d.template gives<PlateTrajectory>().template gives<Measurements>().template gives<ClockMap>();
  d.option("max_gap", &AlignStage::settings_, &AlignmentSettings::plate, &PlateMotionSettings::max_gap,
           "longest silence of the encoder to interpolate across")
      .unit("s")
      .range(1e-4, 10);
  d.option("plate_smoothing", &AlignStage::settings_, &AlignmentSettings::plate,
           &PlateMotionSettings::smoothing,
           "readings of the plate so near to a moment say together where it was between the steps of its "
           "encoder, or those within a half or a quarter of it where it is shaken; no angle is moved by more "
           "than "
           "0.6 steps. 0: as read")
      .unit("s")
      .range(0, 1);
  d.option(
       "mirror_smoothing", &AlignStage::settings_, &AlignmentSettings::mirror_half_width,
       "scans on either side that smooth the motion of a mirror; auto: as many as foretell its stamps best")
      .range(1, 10);
}

template <class S>
void AlignStage::describe_windows(StageDescription<S>& d) {
  d.option("window", &AlignStage::settings_, &AlignmentSettings::window,
           "stretch of stamps that one line is fitted to; what is shorter than 1.5 of it has one line; auto: "
           "60 s, "
           "and up to 240 s where delays are rough")
      .unit("s")
      .range(1, 3600);
  d.option("margin", &AlignStage::settings_, &AlignmentSettings::margin,
           "by how much a piece of the plate's trajectory covers more than its measurements' times")
      .unit("s")
      .range(0, 10);
}

template <class S>
void AlignStage::describe_fit(StageDescription<S>& d) {
  d.option("drift", &AlignStage::drift_,
           "largest change of a clock's rate, in ppm in an hour; a device that warms up "
           "faster needs more")
      .unit("ppm/h")
      .range(0, 1e5);
}

void ConvexHullStage::describe(StageDescription<ConvexHullStage>& d) {
  d.name("clock.convex_hull").summary("puts all stamps on the hub's clock, by the convex hull below them");
  d.details(
      "A telegram comes in late, never early: the device's clock is the line below all pairs of transmission "
      "and receipt time that is nearest to them, an edge of their lower convex hull (Zhang, Liu, Xia 2002). "
      "Long "
      "recordings have a line a window; the map between the windows' middles is straight, so that it follows "
      "a "
      "clock that drifts. A reset of a device begins a new line. After a pause of 5 s, in which nothing came "
      "from any device, another "
      "recording begins, which has nothing in common with the one before it.\n\n"
      "Each beam gets the time at which it was fired: the mirror's motion is taken from the scans' own "
      "stamps, "
      "since mirrors turn up to 0.6 % slower than they should, and wander.");
  describe_alignment(d);
  describe_windows(d);
  describe_fit(d);
}

void OnlineStage::describe(StageDescription<OnlineStage>& d) {
  d.name("clock.online")
      .summary("puts stamps on the hub's clock as they come in, and scans on as soon as they can");
  d.details(
      "For live pipelines: each scan is handed on, with its piece of the plate's trajectory, as soon as the "
      "plate's "
      "readings cover it. A device's clock is the line below its stamps of the last `window` that "
      "clock.convex_hull would find; what was handed on is not corrected when it becomes better known. After "
      "a "
      "restart of a device its clock is a new one, and its scans wait for `warm_up`. The mirror's motion is "
      "taken "
      "from the stamps so far.\n\n"
      "What is handed on depends on the items and their times of receipt alone: from a recording of a live "
      "run the "
      "same stage makes the same measurements. With a calibration from above, the readings that its lags "
      "need are "
      "waited for.");
  describe_alignment(d);
  d.holds<Calibration>(Need::optional);
  d.option("window", &OnlineStage::online_, &OnlineSettings::window,
           "of stamps to which a clock's line is fitted")
      .unit("s")
      .range(1, 3600);
  d.option("warm_up", &OnlineStage::online_, &OnlineSettings::warm_up,
           "of a device's stamps before its clock is believed")
      .unit("s")
      .range(0, 60);
  d.option("margin", &OnlineStage::online_, &OnlineSettings::margin,
           "by how much a piece of the plate's trajectory covers more than its scan, as far as it is there "
           "already")
      .unit("s")
      .range(0, 1);
  d.option("lag_margin", &OnlineStage::online_, &OnlineSettings::lag_margin,
           "by which lags may become greater than the calibration from above says, where calibrate.watch "
           "below finds them anew")
      .unit("s")
      .range(0, 0.1);
  d.option("patience", &OnlineStage::online_, &OnlineSettings::patience,
           "for the plate's readings, after which a scan is handed on without them")
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
  if (context.is_watched()) tell(context);
}

void OnlineStage::tell(Context& context) {
  constexpr double kTellEvery = 0.5;  // [s]
  const auto& aligner = static_cast<const OnlineAligner&>(*aligner_);
  if (!told_) told_ = aligner.now();  // the first stamps say nothing of a skew
  if (aligner.now() - *told_ < kTellEvery) return;
  told_ = aligner.now();
  StageStatus status{.line = "skew"};
  for (const DeviceReport& device : aligner.devices()) {
    const double skew = device.clock ? 1e6 * (device.clock->pieces.back().rate - 1) : 0;
    status.line += fmt::format(" {:+.1f}", skew);
    status.gauges.push_back({"clock_skew_ppm", skew, device.device});
    status.gauges.push_back({"clock_resets_total", static_cast<double>(device.resets), device.device});
  }
  status.line += fmt::format(" ppm, {} scans wait for the plate", aligner.waiting());
  status.gauges.push_back({"scans_waiting", static_cast<double>(aligner.waiting())});
  context.tell(status);
}

void LinearProgramStage::describe(StageDescription<LinearProgramStage>& d) {
  d.name("clock.linear_program").summary("puts all stamps on the hub's clock, by a linear programme");
  d.details(
      "The same line as clock.convex_hull finds, by another algorithm: maximise the height of a line below "
      "all "
      "stamps (Moon, Skelly, Towsley 1999). The two agree to rounding; one checks the other.");
  describe_alignment(d);
  describe_windows(d);
  describe_fit(d);
}

void ReceiptStage::describe(StageDescription<ReceiptStage>& d) {
  d.name("clock.receipt").summary("takes the hub's receipt times as they are, delays and all");
  d.details(
      "The baseline to compare with: each scan is placed by the receipt of its telegram, less the time from "
      "its "
      "stamp to its transmission, and each reading of the plate by its receipt. The clocks are fitted only "
      "to "
      "report the delays that are trusted here.");
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
    throw Error("nothing was received: no scan, no reading of the plate", "check the rig's addresses");
  const AlignmentReport report = aligner_->finish();
  auto devices = nlohmann::json::array();
  for (const auto& device : report.devices) devices.push_back(to_json(device));
  for (const auto& [what, n] : report.counts) context.count(what, n);
  for (const auto& warning : report.warnings) context.warn(warning);
  for (const auto& doubt : report.doubts) context.distrust(doubt);
  context.report(
      {{"devices", devices},
       {"hub_clock", {{"deviation", report.hub_deviation}, {"steps", to_json(report.hub_steps)}}}});
  context.say(table_of(report.devices));
  for (const auto& device : report.devices) {
    if (device.clock) out.give(*device.clock);
  }
}

}  // namespace crisp
