// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/live_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include <crisp/error.hpp>

#include "grabbers/capture/capture_report.hpp"
#include "grabbers/capture/loss_warnings.hpp"
#include "grabbers/live/endpoints.hpp"
#include "grabbers/live/live_status.hpp"

namespace crisp::live {
namespace {

constexpr std::chrono::milliseconds kPatience{50};  // polling interval for a stop of the run

constexpr double kReportEvery = 0.5;  // [s]
constexpr double kFirstWithin = 5;    // [s] for connecting, logging in and a second try

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr std::string_view kNameOf[] = {"grabber.live", "grabber.sick", "grabber.plate"};
constexpr std::string_view kSummaryOf[] = {
    "receives scans and encoder readings from the devices over the network",
    "receives scans from the lasers over the network",
    "receives encoder readings from the plate over the network"};
constexpr std::string_view kAboutLasers =
    "Connects to each laser of the rig at its address (port 2112 unless the rig names one). The stage detects whether it uses CoLa-A or CoLa-B, logs in and starts the measurement, after which the laser streams scans. A connection that breaks or falls silent is re-established, the first time after 0.1 s; telegrams lost in between are counted.";
constexpr std::string_view kAboutPlate =
    "The plate's datagrams are received at the local address `listen`, from the rig's plate only. With `tcp` the stage connects to the rig's plate, with `serial` it reads a serial line; either is reopened when it breaks or falls silent.";
constexpr std::string_view kAboutConfiguration =
    "Lasers keep their configuration unless an option changes it. The summary lists settings that a laser rejects, and scans that differ from the requested settings. Another frequency or resolution restarts the motor, which takes up to a minute. Settings are not stored beyond the laser's next start.";

}  // namespace

template <LiveDevices devices>
void LiveStage<devices>::describe(StageDescription<LiveStage>& d) {
  constexpr auto index = static_cast<std::size_t>(devices);
  d.name(std::string(kNameOf[index])).summary(std::string(kSummaryOf[index]));
  std::string about;
  if constexpr (kLasers) {
    about += std::string(kAboutLasers) + "\n\n" + std::string(kAboutConfiguration) + "\n\n";
  }
  if constexpr (kPlate) about += std::string(kAboutPlate) + "\n\n";
  d.details(
      about +
      "Times of receipt are those of this program. Where the stages below are too slow, the oldest items are dropped and counted.");
  d.endless();
  if constexpr (kLasers) d.template gives<Scan>();
  if constexpr (kPlate) d.template gives<PlateReading>();
  d.option(
       "duration", &LiveStage::duration_,
       "duration from the first item on, which is waited for as long, and at least for 5 s; auto: until Ctrl-C")
      .unit("s")
      .at_least(0);
  d.option("queue", &LiveStage::settings_, &LiveSettings::queue,
           "capacity of the queue to the stages below, in items")
      .range(1, 1e7);
  if constexpr (kLasers) {
    d.option("start", &LiveStage::settings_, &LiveSettings::sick, &SickSettings::start,
             "whether to log into lasers and start their measurement; otherwise scans are only requested");
    d.option("reply_timeout", &LiveStage::settings_, &LiveSettings::sick, &SickSettings::reply_timeout,
             "timeout for a laser's answer")
        .unit("s")
        .range(0.01, 60);
    d.option("silence", &LiveStage::settings_, &LiveSettings::sick, &SickSettings::silence,
             "timeout without a scan, after which a laser is reconnected")
        .unit("s")
        .range(0.05, 600);
    d.option("max_reconnect_delay", &LiveStage::settings_, &LiveSettings::sick,
             &SickSettings::max_reconnect_delay, "largest delay between two attempts to connect")
        .unit("s")
        .range(0.1, 600);
    describe_configuration(d);
  }
  if constexpr (kPlate) describe_plate(d);
}

template <LiveDevices devices>
void LiveStage<devices>::describe_configuration(StageDescription<LiveStage>& d) {
  const auto option = [&](const char* name, auto SickConfiguration::*member, const char* help) {
    return d.option(
        name, [member](LiveStage & stage) -> auto& { return stage.settings_.sick.configuration.*member; },
        help);
  };
  option("scan_frequency", &SickConfiguration::frequency, "frequency of the mirrors to set; auto: unchanged")
      .unit("Hz")
      .range(1, 1000);
  option("resolution", &SickConfiguration::resolution, "angular step to set; auto: unchanged")
      .unit("rad")
      .range(1e-4, 0.1);
  option("output_range", &SickConfiguration::output_range,
         "first and last angle to send, as the lasers report them; none: unchanged")
      .unit("rad")
      .count(0, 2);
  option("remission", &SickConfiguration::remission, "whether remissions are sent; auto: unchanged");
  option("ntp_off", &SickConfiguration::ntp_off,
         "whether to disable the synchronization of lasers' clocks over the network");
}

template <LiveDevices devices>
void LiveStage<devices>::describe_plate(StageDescription<LiveStage>& d) {
  const auto option = [&](const char* name, auto PlateSettings::*member, const char* help) {
    return d.option(name, &LiveStage::settings_, &LiveSettings::plate_at, member, help);
  };
  option("transport", &PlateSettings::transport, "transport of the plate's sentences")
      .choices({{"udp", PlateTransport::Datagrams},
                {"tcp", PlateTransport::Tcp},
                {"serial", PlateTransport::Serial}});
  option("listen", &PlateSettings::listen, "local address that receives the plate's datagrams; 0.0.0.0: all");
  option("serial", &PlateSettings::serial, "the serial line");
  option("baud", &PlateSettings::baud, "bits a second on it").range(50, 4e6);
  option("plate_silence", &PlateSettings::silence,
         "timeout without a reading, after which a connection or serial line is reopened")
      .unit("s")
      .range(0.05, 600);
}

template <LiveDevices devices>
void LiveStage<devices>::check(const RunSettings& run) const {
  AllErrors errors;
  for (const RigLaser& laser : run.rig.lasers) {
    if (kLasers) errors.keep_of([&] { ip_of(laser.address); });
  }
  const auto& plate_at = settings_.plate_at;
  const bool wired = run.rig.plate.encoder_of.has_value();
  if (kPlate && wired && !kLasers)
    errors.keep_of([] {
      throw Error("the plate's encoder is wired to a laser, by encoder_of in the rig",
                  "use grabber.live, which receives from the lasers as well");
    });
  if (kPlate && !wired && plate_at.transport != PlateTransport::Serial) {
    errors.keep_of([&] { ip_of(run.rig.plate.address); });
  }
  if (kPlate && plate_at.transport == PlateTransport::Datagrams) {
    errors.keep_of([&] { ip_of({plate_at.listen, 0}); });
  }
  errors.keep_of([&] { live::check(settings_.sick.configuration); });
  errors.keep_of([&] {
    if (settings_.sick.start || settings_.sick.configuration.is_empty()) return;
    throw Error("lasers without a login cannot be configured", "remove start: false");
  });
  errors.throw_any();
}

template <LiveDevices devices>
void LiveStage<devices>::process(const Inputs&, Outputs& out, Context& context) {
  LiveSource source(context.rig(), settings_);
  LiveStatus status;
  const double began = seconds_now();
  std::optional<double> first;
  double reported = began;
  while (!context.interrupted()) {
    const double now = seconds_now();
    const double elapsed = now - first.value_or(began);
    if (duration_ && elapsed > (first ? *duration_ : std::max(*duration_, kFirstWithin))) break;
    if (context.is_watched() && now - reported >= kReportEvery) {
      reported = now;
      context.set_status(status.report(source.statistics(), now, source.waiting(), running(elapsed)));
    }
    const auto item = source.next_within(kPatience);
    if (!item) continue;
    if (!first) first = now;
    give(*item, out);
    if (context.is_watched()) status.passed(1e-9 * static_cast<double>(now_ns() - receipt_ns(*item)));
  }
  const CaptureStatistics statistics = source.close();
  while (const auto item = source.next_within({})) give(*item, out);  // what came is not lost
  report(statistics, context);
}

template <LiveDevices devices>
void LiveStage<devices>::give(const HubItem& item, Outputs& out) {
  if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
    if constexpr (kLasers) out.give(*scan);
  } else {
    if constexpr (kPlate) out.give(std::get<PlateReading>(item));
  }
}

template <LiveDevices devices>
std::string LiveStage<devices>::running(double elapsed) const {
  return duration_ ? fmt::format("{:.0f} s of {:g} s", elapsed, *duration_)
                   : fmt::format("{:.0f} s", elapsed);
}

template <LiveDevices devices>
void LiveStage<devices>::report(const CaptureStatistics& statistics, Context& context) const {
  context.report(capture::to_json(statistics));
  context.print(capture::device_table(statistics));
  for (const auto& [what, n] : statistics.losses.all()) context.count(what, n);
  for (auto& warning : capture::loss_warnings(statistics)) context.warn(std::move(warning));
  for (auto& caveat : capture::lost_devices(statistics)) context.mark_untrusted(std::move(caveat));
  for (const auto& device : statistics.devices) {
    for (const auto& [what, n] : device.losses.all()) context.count(device.name + ": " + what, n);
    for (const auto& [what, n] : device.notes.all()) context.count(device.name + ": " + what, n);
    if (device.items == 0) context.warn("nothing came from " + capture::title(device));
  }
}

void register_live(Registrar& registrar) {
  registrar.stage<LiveStage<LiveDevices::LasersAndPlate>>();
  registrar.stage<LiveStage<LiveDevices::Lasers>>();
  registrar.stage<LiveStage<LiveDevices::Plate>>();
}

}  // namespace crisp::live
