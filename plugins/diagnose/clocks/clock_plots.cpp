// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clock_plots.hpp"

#include <algorithm>
#include <limits>

#include "pipeline/clocks/envelope.hpp"
#include "pipeline/data/recordings.hpp"
#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::diagnose {
namespace {

using plot::PlotSeries;

constexpr double kMilli = 1e3, kMicro = 1e6;
constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();

/// Shape of a deviation in the envelope, for unit size.
Eigen::VectorXd shape_of(const ClockDeparture& departure, const Eigen::VectorXd& time) {
  if (departure.kind == ClockDeparture::Kind::drift) return time.cwiseAbs2();
  return time.unaryExpr([&](double t) { return t >= departure.at ? 1.0 : 0.0; });
}

/// Device and receipt time of the envelope's stamps, with leads predicted by the line and the deviation.
Eigen::VectorXd fitted(const clocks::Envelope& envelope, const ClockDeparture& departure) {
  if (departure.kind == ClockDeparture::Kind::varying_drift) {
    const Eigen::MatrixXd line = envelope.straight();
    return line * statistics::least_squares(line, envelope.lead) + departure.curve;
  }
  Eigen::MatrixXd design(envelope.time.size(), 3);
  design << envelope.straight(), shape_of(departure, envelope.time);
  return design * statistics::least_squares(design, envelope.lead);
}

void add_point(double x, double y, PlotSeries& series) {
  series.x.push_back(x);
  series.y.push_back(y);
}

/// Whether a pause lies between two stamps, the later one at `last`. Stamps before and after a pause belong
/// to different recordings.
bool is_pause_between(std::span<const clocks::Stamp> stamps, std::size_t first, std::size_t last) {
  for (std::size_t i = first + 1; i <= last; ++i) {
    if (data::is_pause(clocks::receipt_of(stamps[i]) - clocks::receipt_of(stamps[i - 1]))) return true;
  }
  return false;
}

}  // namespace

plot::Plot clock_plot(const std::string& device, std::span<const CountedStamp> stamps,
                      const std::optional<ClockDeparture>& departure) {
  constexpr std::size_t kMaxPoints = 1000;
  const std::vector<clocks::Stamp> all = without_counts(stamps);
  const clocks::ClockLine line = line_of(all);
  const auto delay_ms = [&](const clocks::Stamp& s, double lead) {
    return kMilli * (lead - line.lead(s.device));
  };
  PlotSeries telegrams{.name = "telegrams", .x = {}, .y = {}, .joined = false};
  for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / kMaxPoints) {
    add_point(clocks::receipt_of(all[i]), delay_ms(all[i], all[i].lead), telegrams);
  }
  plot::Plot plot{.title = device + ": receipt less device time, about the clock",
                  .x_label = "time since the first telegram [s]",
                  .y_label = "delay [ms]",
                  .series = {std::move(telegrams)}};
  if (!departure) return plot;
  const clocks::Envelope envelope = clocks::envelope_of(all);
  const Eigen::VectorXd leads = fitted(envelope, *departure);
  PlotSeries least{.name = "minimum of each window", .x = {}, .y = {}};
  PlotSeries found{.name = "fitted", .x = {}, .y = {}};
  for (std::size_t w = 0; w < envelope.stamp.size(); ++w) {
    const clocks::Stamp& stamp = all[envelope.stamp[w]];
    if (w > 0 && is_pause_between(all, envelope.stamp[w - 1], envelope.stamp[w])) {
      for (PlotSeries* series : {&least, &found}) add_point(kBreak, kBreak, *series);
    }
    add_point(clocks::receipt_of(stamp), delay_ms(stamp, stamp.lead), least);
    add_point(clocks::receipt_of(stamp), delay_ms(stamp, leads[static_cast<Eigen::Index>(w)]), found);
  }
  plot.series.push_back(std::move(least));
  if (departure->kind != ClockDeparture::Kind::backlog) plot.series.push_back(std::move(found));
  return plot;
}

plot::Plot mirror_plot(const std::string& device, const MirrorFacts& facts, double nominal) {
  PlotSeries measured{.name = "measured", .x = {}, .y = {}};
  PlotSeries expected{.name = "nominal", .x = {}, .y = {}};
  for (std::size_t i = 0; i < facts.periods.size(); ++i) {
    if (i > 0 && data::is_pause(facts.begin[i] - facts.begin[i - 1])) add_point(kBreak, kBreak, measured);
    add_point(facts.begin[i], kMicro * facts.periods[i], measured);
    add_point(facts.begin[i], kMicro * nominal, expected);
  }
  plot::Plot plot{.title = device + ": period of the mirror, mean of eight turns",
                  .x_label = "time since the first telegram [s]",
                  .y_label = "period [us]",
                  .series = {std::move(measured)}};
  plot.series.push_back(std::move(expected));
  return plot;
}

}  // namespace crisp::diagnose
