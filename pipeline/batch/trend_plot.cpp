// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "pipeline/batch/trend.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "pipeline/plot/plot.hpp"

namespace crisp::batch {
namespace {

plot::Plot plot_of(const ParameterTrend& trend) {
  constexpr std::size_t kMax = 5000;  // points that are drawn of those that do not stand out
  const std::size_t every = 1 + trend.points.size() / kMax;
  const auto [scale, unit] = data::shown_unit(trend.unit);
  plot::PlotSeries alike{.name = "recordings", .joined = false};
  plot::PlotSeries apart{.name = "stands out", .joined = false};
  for (std::size_t i = 0; i < trend.points.size(); ++i) {
    const TrendPoint& point = trend.points[i];
    const bool stands_out = point.p_value < kStandsOut;
    if (!stands_out && i % every != 0) continue;
    plot::PlotSeries& series = stands_out ? apart : alike;
    series.x.push_back(static_cast<double>(i + 1));
    series.y.push_back(point.value * scale);
    series.error.push_back(point.std_error * scale);
  }
  plot::PlotSeries centre{.name = "median", .x = {1, static_cast<double>(trend.points.size())}};
  centre.y.assign(2, trend.centre * scale);
  plot::Plot plot{.title = trend.name,
                  .x_label = "recording, in the order of time",
                  .y_label = fmt::format("{} [{}]", trend.name, unit),
                  .series = {std::move(alike), std::move(centre)}};
  if (!apart.x.empty()) plot.series.push_back(std::move(apart));
  return plot;
}

}  // namespace

std::string trend_svg(const std::vector<ParameterTrend>& trends) {
  std::vector<plot::Plot> plots;
  for (const auto& trend : trends) plots.push_back(plot_of(trend));
  return plot::as_svg(plots);
}

nlohmann::ordered_json trend_json(const std::vector<ParameterTrend>& trends) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& trend : trends) {
    auto apart = nlohmann::ordered_json::array();
    for (const auto& point : trend.points) {
      if (point.p_value < kStandsOut)
        apart.push_back({{"recording", point.recording},
                         {"value", point.value},
                         {"std_error", point.std_error},
                         {"p_value", point.p_value}});
    }
    json.push_back({{"parameter", trend.name},
                    {"unit", trend.unit},
                    {"median", trend.centre},
                    {"std_error", trend.centre_error},
                    {"chi2_per_degree_of_freedom", trend.chi2},
                    {"recordings", trend.points.size()},
                    {"stand_out", std::move(apart)}});
  }
  return json;
}

}  // namespace crisp::batch
