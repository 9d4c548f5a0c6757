// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/live_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "grabbers/capture/capture_report.hpp"
#include "grabbers/capture/loss_warnings.hpp"
#include "grabbers/live/endpoints.hpp"
#include "grabbers/live/live_status.hpp"
#include "pipeline/data/all_errors.hpp"
#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

constexpr std::chrono::milliseconds kPatience{50};  // between two looks at whether the run is to stop

constexpr double kTellEvery = 0.5;  // [s]
constexpr double kFirstWithin = 5;  // [s] for connecting, logging in and a second try

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr std::string_view kNameOf[] = {"grabber.live", "grabber.sick", "grabber.plate"};
constexpr std::string_view kSummaryOf[] = {"receives scans and plate readings from the devices themselves",
                                           "receives scans from the lasers themselves",
                                           "receives the plate's readings from itself"};
constexpr std::string_view kAboutLasers =
    "Each laser of the rig is connected to at its address (port 2112 unless the rig names one). Whether it "
    "speaks "
    "CoLa-A or CoLa-B is found out; it is logged into and told to measure, and then sends scans by itself. A "
    "connection that breaks or falls silent is made anew, the first time after 0.1 s; what never came in "
    "between is "
    "counted.";
constexpr std::string_view kAboutPlate =
    "The plate's datagrams are taken at the address `listen` of this machine, from the rig's plate only. "
    "Over "
    "`tcp` the rig's plate is connected to, over `serial` a serial line is read; either is opened anew when "
    "it "
    "breaks or falls silent.";
constexpr std::string_view kAboutConfiguration =
    "Lasers are left as they are configured unless an option says otherwise. What a laser refuses, and scans "
    "that "
    "are not as it was told, are said in the summary. Another frequency or resolution makes the motor turn "
    "anew, "
    "which takes up to a minute. Nothing is stored beyond the laser's next start.";

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
  d.details(about +
            "Times of receipt are those at which this program took the data. Where the stages below are too "
            "slow, the "
            "oldest items are dropped, and counted.");
  d.endless();
  if constexpr (kLasers) d.template gives<Scan>();
  if constexpr (kPlate) d.template gives<PlateReading>();
  d.option("duration", &LiveStage::duration_,
           "how long from the first item on, which is waited for as long, and at least for 5 s; auto: until "
           "Ctrl-C")
      .unit("s")
      .at_least(0);
  d.option("queue", &LiveStage::settings_, &LiveSettings::queue, "items that may wait for the stages below")
      .range(1, 1e7);
  if constexpr (kLasers) {
    d.option("start", &LiveStage::settings_, &LiveSettings::sick, &SickSettings::start,
             "whether lasers are logged into and told to measure; otherwise they are only asked for scans");
    d.option("reply_timeout", &LiveStage::settings_, &LiveSettings::sick, &SickSettings::reply_timeout,
             "how long a laser's answer is waited for")
        .unit("s")
        .range(0.01, 60);
    d.option("silence", &LiveStage::settings_, &LiveSettings::sick, &SickSettings::silence,
             "without a scan for so long, a laser is connected to anew")
        .unit("s")
        .range(0.05, 600);
    d.option("longest_pause", &LiveStage::settings_, &LiveSettings::sick, &SickSettings::longest_pause,
             "between two tries to connect, at most")
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
  option("scan_frequency", &SickConfiguration::frequency,
         "how often the mirrors are to turn; auto: as they do")
      .unit("Hz")
      .range(1, 1000);
  option("resolution", &SickConfiguration::resolution, "angle from beam to beam; auto: as it is")
      .unit("rad")
      .range(1e-4, 0.1);
  option("output_range", &SickConfiguration::output_range,
         "first and last angle that are sent, as the lasers report them; none: as it is")
      .unit("rad")
      .count(0, 2);
  option("remission", &SickConfiguration::remission, "whether remissions are sent; auto: as it is");
  option("ntp_off", &SickConfiguration::ntp_off,
         "whether lasers are told not to have their clocks set over the network");
}

template <LiveDevices devices>
void LiveStage<devices>::describe_plate(StageDescription<LiveStage>& d) {
  const auto option = [&](const char* name, auto PlateSettings::*member, const char* help) {
    return d.option(name, &LiveStage::settings_, &LiveSettings::plate_at, member, help);
  };
  option("transport", &PlateSettings::transport, "how the plate's sentences come")
      .choices({{"udp", PlateTransport::Datagrams},
                {"tcp", PlateTransport::Tcp},
                {"serial", PlateTransport::Serial}});
  option("listen", &PlateSettings::listen,
         "address of this machine at which the plate's datagrams are taken; 0.0.0.0: all that it has");
  option("serial", &PlateSettings::serial, "the serial line");
  option("baud", &PlateSettings::baud, "bits a second on it").range(50, 4e6);
  option("plate_silence", &PlateSettings::silence,
         "without a reading for so long, a connection or serial line is opened anew")
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
  if (kPlate && plate_at.transport != PlateTransport::Serial) {
    errors.keep_of([&] { ip_of(run.rig.plate.address); });
  }
  if (kPlate && plate_at.transport == PlateTransport::Datagrams) {
    errors.keep_of([&] { ip_of({plate_at.listen, 0}); });
  }
  errors.keep_of([&] { crisp::check(settings_.sick.configuration); });
  errors.keep_of([&] {
    if (settings_.sick.start || settings_.sick.configuration.is_empty()) return;
    throw Error("lasers that are not logged into cannot be configured", "leave out start: false");
  });
  errors.throw_any();
}

template <LiveDevices devices>
void LiveStage<devices>::process(const Inputs&, Outputs& out, Context& context) {
  LiveSource source(context.rig(), settings_);
  LiveStatus status;
  const double began = seconds_now();
  std::optional<double> first;
  double told = began;
  while (!context.interrupted()) {
    const double now = seconds_now();
    const double elapsed = now - first.value_or(began);
    if (duration_ && elapsed > (first ? *duration_ : std::max(*duration_, kFirstWithin))) break;
    if (context.is_watched() && now - told >= kTellEvery) {
      told = now;
      context.tell(status.tell(source.statistics(), now, source.waiting(), running(elapsed)));
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
  context.report(to_json(statistics));
  context.say(device_table(statistics));
  for (const auto& [what, n] : statistics.losses.all()) context.count(what, n);
  for (auto& warning : loss_warnings(statistics)) context.warn(std::move(warning));
  for (auto& caveat : lost_devices(statistics)) context.distrust(std::move(caveat));
  for (const auto& device : statistics.devices) {
    for (const auto& [what, n] : device.losses.all()) context.count(device.name + ": " + what, n);
    for (const auto& [what, n] : device.notes.all()) context.count(device.name + ": " + what, n);
    if (device.items == 0) context.warn("nothing came from " + title(device));
  }
}

void register_live(Registrar& registrar) {
  registrar.stage<LiveStage<LiveDevices::LasersAndPlate>>();
  registrar.stage<LiveStage<LiveDevices::Lasers>>();
  registrar.stage<LiveStage<LiveDevices::Plate>>();
}

}  // namespace crisp
