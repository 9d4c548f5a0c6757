// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clocks_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>

#include <crisp/scan.hpp>

#include "pipeline/clocks/envelope.hpp"
#include "pipeline/clocks/unwrap.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/clocks/clock_plots.hpp"
#include "plugins/diagnose/noise/permutation_test.hpp"
#include "plugins/diagnose/report/findings_report.hpp"

namespace crisp::diagnose {
namespace {

Parameter parameter(const char* name, const char* unit, double value, double std_error) {
  return {.name = name, .unit = unit, .value = value, .std_error = std_error, .free = true};
}

const char* cause_of(ClockDeparture::Kind kind) {
  switch (kind) {
    case ClockDeparture::Kind::drift:
    case ClockDeparture::Kind::varying_drift:
      return "clock.drift";
    case ClockDeparture::Kind::clock_step:
      return "clock.step";
    case ClockDeparture::Kind::latency_step:
      return "latency.step";
    case ClockDeparture::Kind::backlog:
      break;
  }
  return "";
}

Finding finding_of(const ClockDeparture& departure, const std::string& device) {
  Finding finding{.cause = cause_of(departure.kind),
                  .scope = device,
                  .parameters = {},
                  .explained_fraction = departure.gain.explained(),
                  .p_value = departure.p_value,
                  .confounded_with = {},
                  .gain = {departure.gain},
                  .accepted = departure.gain.significant_decrease()};
  if (departure.kind == ClockDeparture::Kind::drift) {
    finding.parameters = {parameter("skew", "1", departure.skew, departure.skew_std_error),
                          parameter("drift", "1/s", departure.size, departure.std_error)};
  } else if (departure.kind == ClockDeparture::Kind::varying_drift) {
    finding.parameters = {parameter("rms", "s", departure.size, departure.std_error)};
  } else {
    finding.parameters = {parameter("by", "s", departure.size, departure.std_error),
                          parameter("at", "s", departure.at, departure.at_std_error)};
  }
  constexpr double kEven = 2;  // log10 of the Bayes factor below which causes are not resolvable
  if (!departure.competitors.empty())
    finding.log10_bayes_factor = departure.competitors.front().log10_bayes_factor;
  for (const auto& [kind, odds] : departure.competitors) {
    if (!kind) continue;
    finding.alternatives.push_back({.cause = cause_of(*kind), .scope = device, .log10_bayes_factor = odds});
    if (odds < kEven) finding.confounded_with.push_back(device + "." + cause_of(*kind));
  }
  return finding;
}

std::string facts_in_words(const std::vector<DeviceFacts>& devices) {
  std::string words =
      "stamps              skew ppm       delay median, 95 %    mirror against nominal   wander";
  for (const DeviceFacts& facts : devices) {
    words += fmt::format("\n  {:<12}", facts.device);
    if (std::isnan(facts.skew)) {
      words += fmt::format("  clock not identifiable from {} stamps", facts.stamps);
      continue;
    }
    words += fmt::format("{:>+9.2f} ± {:<6.2f} {:>8.3f}, {:>7.3f} ms", facts.skew * 1e6,
                         facts.skew_std_error * 1e6, facts.delay_median * 1e3, facts.delay_95 * 1e3);
    if (facts.period > 0 && facts.nominal_period > 0) {
      words += fmt::format("{:>+14.3f} ± {:.3f} %{:>9.3f} %", 100 * (facts.nominal_period / facts.period - 1),
                           100 * facts.period_std_error / facts.period, 100 * facts.wander);
    }
  }
  return words;
}

/// Reports what too few stamps, or stamps that are counts times the nominal period, cannot identify.
void report_unknown(const DeviceFacts& facts, bool has_mirror, bool timed, Findings& all) {
  const auto why = fmt::format("{} stamps are too few", facts.stamps);
  if (std::isnan(facts.skew)) all.unobservable.push_back({facts.device + ".clock.drift", why, ""});
  if (has_mirror && std::isnan(facts.period)) {
    all.unobservable.push_back(
        {facts.device + ".mirror.period",
         timed
             ? why
             : "no device clock timed its scans: their times are multiples of the nominal period, or receipt times",
         ""});
  }
}

/// Caveat about an implausible clock fit; empty if it is plausible. One wrong receipt time suffices: the line
/// lies below all stamps, so that stamp determines it.
std::string caveat_of(const DeviceFacts& facts) {
  constexpr double kFar =
      1e-3;  // [s] largest plausible median distance; few stamps tilt the line, but stay near
  constexpr double kNoDelay = 1;  // [s] larger than any median delay of a link
  const bool steep = std::abs(facts.skew) >= 0.99 * clocks::kMaxSkew;
  const bool unknown = facts.skew_std_error >= 0.9 * clocks::kMaxSkew;  // the data do not constrain the skew
  if (!((steep || unknown) && facts.delay_median > kFar) && !(facts.delay_median > kNoDelay)) return {};
  return fmt::format(
      "{}: its stamps fit no clock of constant rate ({:+.0f} ± {:.0f} ppm; median distance {:.1f} ms). One wrong receipt or device time suffices for that. Check the plot of its stamps",
      facts.device, 1e6 * facts.skew, 1e6 * facts.skew_std_error, 1e3 * facts.delay_median);
}

}  // namespace

void DiagnoseClocksStage::describe(StageDescription<DiagnoseClocksStage>& d) {
  d.name("diagnose.clocks").summary("tests clocks, links and mirrors by the telegrams' timestamps");
  d.details(
      "Receipt less device time has a lower envelope, since telegrams arrive late but never early. The stage evaluates the minimum delay in each of up to 64 windows of the recording. It tests for deviations from a clock of constant rate and a link of constant minimum delay: a drift of the clock (`clock.drift`; where its rate varies, with the RMS of the minimum delays about a clock of constant rate), a step of the clock (`clock.step`: the device's own time jumps between two telegrams), and a step of the link's minimum delay (`latency.step`). A backlog, late telegrams without a common level, is reported as `unnamed` over time. The p-values come from permutation tests of the minimum delays, the gain from every other window (cross-validation). The stage also lists skews, delays, and the mirrors' rates against nominal. It uses the recording with the most stamps if there are several, separated by pauses of 5 s.");
  d.takes<Scan>().takes<PlateReading>(Need::optional).takes<Findings>(Need::optional).gives<Findings>();
  d.option(
      "nominal_mirrors", &DiagnoseClocksStage::nominal_mirrors_,
      "whether to report a mirror's deviation from its nominal rate (`mirror.period`); points are not affected by it, since clock stages use the measured rate");
  d.option("folder", &DiagnoseClocksStage::folder_,
           "folder for plots of each device's stamps; auto: no plots")
      .writes_into({"*_stamps.svg"});
}

DiagnoseClocksStage::Device& DiagnoseClocksStage::device(std::size_t index, const Rig& rig) {
  if (devices_.empty()) {
    for (const RigLaser& laser : rig.lasers)
      devices_.push_back({.name = laser.name, .telegrams = {}, .passes = {}});
    devices_.push_back({.name = rig.plate.name, .telegrams = {}, .passes = {}});
  }
  return devices_.at(index);
}

/// Clocks of different recordings are unrelated, so the recording with the most stamps is used.
void DiagnoseClocksStage::arrive(std::int64_t receipt_ns) {
  if (pauses_.hear(receipt_ns)) end_recording();
  first_ns_ = std::min(first_ns_.value_or(receipt_ns), receipt_ns);
}

void DiagnoseClocksStage::end_recording() {
  const auto stamps = [](const std::vector<Device>& devices) {
    std::size_t sum = 0;
    for (const Device& device : devices) sum += device.telegrams.stamps().size();
    return sum;
  };
  if (stamps(devices_) > stamps(longest_)) longest_ = std::move(devices_);
  devices_.clear();
}

void DiagnoseClocksStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) all_.append(*before);
  if (const Scan* scan = in.find<Scan>()) {
    arrive(scan->receipt_ns);
    Device& laser = device(scan->laser, context.rig());
    laser.telegrams.add(scan->telegram_counter, scan->transmission_time_us, scan->receipt_ns);
    laser.timed = laser.timed && scan->timed;
    if (scan->timed) laser.passes.add(scan->scan_counter, scan->scan_time_us, scan->receipt_ns);
    if (scan->scan_frequency > 0) laser.nominal_period = 1 / scan->scan_frequency;
  }
  if (const PlateReading* reading = in.find<PlateReading>()) {
    arrive(reading->receipt_ns);
    device(context.rig().lasers.size(), context.rig())
        .telegrams.add(reading->sequence, reading->device_us, reading->receipt_ns);
  }
}

void DiagnoseClocksStage::add_clock(const Device& device, std::size_t tests, Context& context,
                                    Findings& all) const {
  const auto stamps = device.telegrams.stamps();
  auto departure = clock_departure(stamps, tests, context.seed());
  const auto as_usual = [&](std::span<const CountedStamp> some) {
    return departure ? without_step(some, *departure) : std::vector(some.begin(), some.end());
  };
  const ClockFacts clock = clock_facts(as_usual(stamps));
  DeviceFacts facts{.device = device.name,
                    .stamps = stamps.size(),
                    .skew = clock.skew,
                    .skew_std_error = clock.skew_std_error,
                    .delay_median = clock.delay_median,
                    .delay_95 = clock.delay_95};
  const auto mirror = mirror_facts(device.passes.stamps(), clock_step_interval(departure));
  if (device.has_mirror()) facts.nominal_period = device.nominal_period;
  if (mirror) {
    facts.period = mirror->period;
    facts.period_std_error = mirror->period_std_error;
    facts.wander = mirror->wander;
    if (nominal_mirrors_ && device.nominal_period > 0) {
      add_mirror(device, on_hubs_clock(*mirror, clock), context.seed(), all);
    }
  }
  report_unknown(facts, device.has_mirror(), device.timed, all);
  if (auto caveat = caveat_of(facts); !caveat.empty()) context.mark_untrusted(std::move(caveat));
  all.devices.push_back(facts);
  if (folder_ && stamps.size() > 1) {
    std::vector<plot::Plot> plots = {clock_plot(device.name, stamps, departure)};
    if (mirror && device.nominal_period > 0)
      plots.push_back(mirror_plot(device.name, *mirror, device.nominal_period));
    plot::write_plots(*folder_ / (device.name + "_stamps.svg"), plots, context);
  }
  if (departure && departure->kind == ClockDeparture::Kind::backlog) {
    all.unnamed.push_back({.covariate = "time",
                           .quantity = "delay",
                           .scope = device.name,
                           .amplitude = departure->size,
                           .unit = "s",
                           .p_value = departure->p_value,
                           .gain = {}});
  } else if (departure) {
    departure->at +=
        1e-9 * static_cast<double>(device.telegrams.first_ns() - clocks::epoch_of_run(*first_ns_));
    all.findings.push_back(finding_of(*departure, device.name));
  }
}

void DiagnoseClocksStage::add_mirror(const Device& device, const MirrorFacts& facts, std::uint64_t seed,
                                     Findings& all) const {
  const double excess = facts.period - device.nominal_period;
  const double z = std::abs(excess) / facts.period_std_error;
  const double p = 2 * cdf(complement(boost::math::normal(), z)) * static_cast<double>(longest_.size());
  if (!(p < kSignificantInSeries)) return;
  const Gain gain = gain_over_nominal(facts, device.nominal_period, seed);
  const double price = std::log(static_cast<double>(facts.periods.size()));  // BIC penalty of one parameter
  all.findings.push_back({.cause = "mirror.period",
                          .scope = device.name,
                          .parameters = {parameter("excess", "s", excess, facts.period_std_error)},
                          .explained_fraction = gain.explained(),
                          .log10_bayes_factor = (z * z - price) / 2 / std::numbers::ln10,
                          .p_value = p,
                          .confounded_with = {},
                          .gain = {gain},
                          .accepted = gain.significant_decrease()});
}

/// [s] Hub time of a track's first stamp since the run's first.
double DiagnoseClocksStage::hub_time(const StampTrack& track) const {
  return 1e-9 * static_cast<double>(track.first_ns() - *first_ns_);
}

/// A deviation that all devices' clocks share is the hub's, and no finding of each.
void DiagnoseClocksStage::take_out_hub_deviation(Context& context) {
  std::vector<std::vector<clocks::ReceivedStamp>> stamps;
  for (const Device& device : longest_) {
    auto& received = stamps.emplace_back();
    for (const CountedStamp& s : device.telegrams.stamps())
      received.push_back(
          {.hub = hub_time(device.telegrams) + clocks::receipt_of(s.stamp), .lead = s.stamp.lead});
  }
  const auto deviation = clocks::find_hub_deviation(stamps);
  if (!deviation) return;
  context.print(fmt::format(
      "the hub's clock deviates by up to {:.3f} ms from those of all devices; the tests below are without that",
      1e3 * deviation->largest()));
  for (Device& device : longest_) {
    device.telegrams.take_out(*deviation, hub_time(device.telegrams));
    device.passes.take_out(*deviation, hub_time(device.passes));
  }
}

void DiagnoseClocksStage::finish(Outputs& out, Context& context) {
  end_recording();
  if (first_ns_) take_out_hub_deviation(context);
  Findings all;
  std::size_t tests = 0;
  for (const Device& device : longest_) tests += device.telegrams.stamps().empty() ? 0 : 1;
  for (const Device& device : longest_) {
    if (!device.telegrams.stamps().empty()) add_clock(device, tests, context, all);
  }
  context.print(facts_in_words(all.devices));
  for (const Finding& finding : all.findings) context.print(in_words(finding));
  for (const UnnamedFinding& finding : all.unnamed) context.print(in_words(finding));
  context.report({{"findings", all.findings.size()}, {"unnamed", all.unnamed.size()}});
  all_.append(all);
  out.give(std::move(all_));
}

}  // namespace crisp::diagnose
