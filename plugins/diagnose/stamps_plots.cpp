// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/stamps_plots.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "pipeline/clocks/envelope.hpp"

namespace crisp {
namespace {

constexpr double kMilli = 1e3, kMicro = 1e6;

/// What a departure does to the envelope, but for its size.
Eigen::VectorXd shape_of(const ClockDeparture& departure, const Eigen::VectorXd& time) {
  if (departure.kind == ClockDeparture::Kind::drift) return time.cwiseAbs2();
  return time.unaryExpr([&](double t) { return t >= departure.at ? 1.0 : 0.0; });
}

/// Device time and receipt of the envelope's stamps, with the leads that a line and the departure give them.
Eigen::VectorXd fitted(const Envelope& envelope, const ClockDeparture& departure) {
  Eigen::MatrixXd design(envelope.time.size(), 3);
  design << envelope.straight(), shape_of(departure, envelope.time);
  return design * design.colPivHouseholderQr().solve(envelope.lead);
}

}  // namespace

Plot clock_plot(const std::string& device, std::span<const CountedStamp> stamps,
                const std::optional<ClockDeparture>& departure) {
  constexpr std::size_t kMostPoints = 1000;
  const std::vector<Stamp> all = bare(stamps);
  const ClockLine line = line_of(all);
  const auto delay_ms = [&](const Stamp& s, double lead) { return kMilli * (lead - line.lead(s.device)); };
  PlotSeries telegrams{.name = "telegrams", .x = {}, .y = {}, .joined = false};
  for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / kMostPoints) {
    telegrams.x.push_back(receipt_of(all[i]));
    telegrams.y.push_back(delay_ms(all[i], all[i].lead));
  }
  Plot plot{.title = device + ": receipt less device time, about the clock",
            .x_label = "time since the first telegram [s]",
            .y_label = "delay [ms]",
            .series = {std::move(telegrams)}};
  if (!departure) return plot;
  const Envelope envelope = envelope_of(all);
  const Eigen::VectorXd leads = fitted(envelope, *departure);
  PlotSeries least{.name = "least of each stretch", .x = {}, .y = {}};
  PlotSeries found{.name = "as found", .x = {}, .y = {}};
  for (std::size_t w = 0; w < envelope.stamp.size(); ++w) {
    const Stamp& stamp = all[envelope.stamp[w]];
    least.x.push_back(receipt_of(stamp));
    least.y.push_back(delay_ms(stamp, stamp.lead));
    found.x.push_back(receipt_of(stamp));
    found.y.push_back(delay_ms(stamp, leads[static_cast<Eigen::Index>(w)]));
  }
  plot.series.push_back(std::move(least));
  if (departure->kind != ClockDeparture::Kind::backlog) plot.series.push_back(std::move(found));
  return plot;
}

Plot mirror_plot(const std::string& device, const MirrorFacts& facts, double nominal) {
  PlotSeries measured{.name = "measured", .x = {}, .y = {}};
  PlotSeries expected{.name = "nominal", .x = {}, .y = {}};
  double time = 0;
  for (const double period : facts.periods) {
    measured.x.push_back(time);
    expected.x.push_back(time);
    measured.y.push_back(kMicro * period);
    expected.y.push_back(kMicro * nominal);
    time += kTurnsOfPiece * period;
  }
  Plot plot{.title = device + ": period of the mirror, of eight turns each",
            .x_label = "time since the first turn [s]",
            .y_label = "period [us]",
            .series = {std::move(measured)}};
  plot.series.push_back(std::move(expected));
  return plot;
}

}  // namespace crisp
