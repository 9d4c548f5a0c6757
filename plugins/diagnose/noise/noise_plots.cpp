// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/noise_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/data/degree.hpp"
#include "pipeline/statistics/histogram.hpp"
#include "plugins/diagnose/noise/noise_components.hpp"

namespace crisp::diagnose {
namespace {

using plot::Plot;
using plot::PlotSeries;

constexpr double kBarLength = 2;  // [standard errors]

/// [1/m] Density of a noise model, averaged over the measured ranges and beams.
double mean_density(const NoiseModel& model, const RangeErrors& errors, double value) {
  constexpr std::size_t kEnough = 500;
  const std::size_t stride = std::max<std::size_t>(1, errors.size() / kEnough);
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < errors.size(); i += stride) {
    sum += std::exp(model.log_density(value, errors.echo(i), errors.beam[i]));
    count += 1;
  }
  return sum / count;
}

/// [1/mm] Density for the plot; NaN below the density of a single range.
double shown_density(double density, double least) {
  return density >= least ? 1e-3 * density : std::numeric_limits<double>::quiet_NaN();
}

PlotSeries model_over(const std::string& name, const NoiseModel& model, const RangeErrors& errors,
                      const statistics::Histogram& bins, double least) {
  PlotSeries series{.name = name, .x = {}, .y = {}};
  for (std::size_t b = 0; b < bins.count.size(); ++b) {
    series.x.push_back(1e3 * bins.middle(b));
    series.y.push_back(shown_density(mean_density(model, errors, bins.middle(b)), least));
  }
  return series;
}

Plot distribution(const std::string& name, const RangeErrors& errors, const NoiseDiagnosis& noise) {
  constexpr std::size_t kBins = 81;
  constexpr double kShown = 0.9995;  // share of the errors in the plot
  std::vector<float> sizes;
  for (const float error : errors.value) sizes.push_back(std::abs(error));
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(kShown * static_cast<double>(sizes.size() - 1));
  std::ranges::nth_element(sizes, at);
  const double farthest = std::max(1e-6, double{*at});
  statistics::Histogram bins(-farthest, farthest, kBins);
  for (const float error : errors.value) bins.add(double{error});
  const double one = 1 / (bins.all * bins.width);  // [1/m] of a single range in a bin
  PlotSeries measured{.name = "measured", .x = {}, .y = {}, .joined = false};
  for (std::size_t b = 0; b < kBins; ++b) {
    measured.x.push_back(1e3 * bins.middle(b));
    measured.y.push_back(shown_density(bins.count[b] * one, one));
    measured.error.push_back(kBarLength * std::sqrt(bins.count[b]) * 1e-3 * one);
  }
  Plot plot{.title = fmt::format("{}: {} ranges about the mean of their beams", name, errors.size()),
            .x_label = "error [mm]",
            .y_label = "density [1/mm], logarithmic",
            .series = {measured, model_over("normal noise", noise.plain, errors, bins, one)},
            .y_scale = plot::PlotScale::logarithmic};
  if (!noise.model.is_normal()) {
    plot.series.push_back(model_over("noise model", noise.model, errors, bins, one));
  }
  return plot;
}

/// Share of each bin [%], with the uniform distribution.
std::vector<PlotSeries> next_to_even(const statistics::Histogram& bins, double unit) {
  PlotSeries measured{.name = "measured", .x = {}, .y = {}, .joined = false};
  PlotSeries even{.name = "uniform", .x = {}, .y = {}};
  for (std::size_t b = 0; b < bins.count.size(); ++b) {
    const double all = std::max(1.0, bins.all);
    for (PlotSeries* series : {&measured, &even}) series->x.push_back(bins.middle(b) / unit);
    measured.y.push_back(100 * bins.count[b] / all);
    measured.error.push_back(100 * kBarLength * std::sqrt(bins.count[b]) / all);
    even.y.push_back(100 / static_cast<double>(bins.count.size()));
  }
  return {measured, even};
}

/// A covariate of the ranges.
struct NoiseCovariate {
  std::string name;
  std::string label;  // including its unit
  std::span<const float> values;
};

/// RMS error in quantile bins of a covariate.
Plot noise_over(const NoiseCovariate& over, const std::string& name, const RangeErrors& errors,
                const NoiseDiagnosis& noise) {
  constexpr std::size_t kBins = 12;
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return over.values[i]; });
  PlotSeries measured{.name = "measured", .x = {}, .y = {}, .joined = false};
  PlotSeries plain{.name = "normal noise", .x = {}, .y = {}};
  PlotSeries found{.name = "noise model", .x = {}, .y = {}};
  for (std::size_t b = 0; b < kBins; ++b) {
    const std::size_t begin = b * order.size() / kBins;
    const std::size_t end = (b + 1) * order.size() / kBins;
    if (begin == end) continue;
    double sum = 0, squares = 0, fourths = 0, of_plain = 0, of_found = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = order[k];
      sum += double{over.values[i]};
      squares += std::pow(double{errors.value[i]}, 2);
      fourths += std::pow(double{errors.value[i]}, 4);
      of_plain += noise.plain.variance(errors.echo(i), errors.beam[i]);
      of_found += noise.model.variance(errors.echo(i), errors.beam[i]);
    }
    const auto count = static_cast<double>(end - begin);
    const double rms = 1e3 * std::sqrt(squares / count);
    for (PlotSeries* series : {&measured, &plain, &found}) series->x.push_back(sum / count);
    measured.y.push_back(rms);
    // By fourth moments, since heavy tails make the mean square scatter more than a normal distribution.
    const double error_of_squares = std::sqrt(std::max(0.0, fourths - squares * squares / count)) / count;
    measured.error.push_back(kBarLength * 1e6 * error_of_squares / (2 * rms));
    plain.y.push_back(1e3 * std::sqrt(of_plain / count));
    found.y.push_back(1e3 * std::sqrt(of_found / count));
  }
  Plot plot{.title = name + ": noise over the " + over.name,
            .x_label = over.label,
            .y_label = "RMS error [mm]",
            .series = {measured, plain}};
  if (!noise.model.is_normal()) plot.series.push_back(found);
  return plot;
}

std::vector<float> incidence_in_degrees(const RangeErrors& errors) {
  std::vector<float> degrees;
  for (const float cosine : errors.cosine)
    degrees.push_back(static_cast<float>(std::acos(std::clamp(double{cosine}, -1.0, 1.0)) / data::kDegree));
  return degrees;
}

}  // namespace

std::vector<Plot> noise_plots(const std::string& name, const RangeErrors& errors,
                              const NoiseDiagnosis& noise) {
  if (errors.size() == 0) return {};
  std::vector<Plot> plots = {
      distribution(name, errors, noise),
      noise_over({.name = "range", .label = "range [m]", .values = errors.range}, name, errors, noise)};
  const std::vector<float> incidence = incidence_in_degrees(errors);
  for (const NoiseCovariate& over :
       {NoiseCovariate{"incidence", "incidence [deg]", incidence},
        NoiseCovariate{"remission", "remission [device's units]", errors.remission}}) {
    if (are_various(over.values)) plots.push_back(noise_over(over, name, errors, noise));
  }
  return plots;
}

Plot quantization_plot(const std::string& name, std::span<const float> ranges, double step) {
  constexpr std::size_t kBins = 40;
  statistics::Histogram bins(-step / 2, step / 2, kBins);
  for (const float range : ranges) bins.add(std::remainder(double{range}, step));
  return {.title = fmt::format("{}: remainders of ranges modulo {:.4g} mm", name, 1e3 * step),
          .x_label = "remainder [mm]",
          .y_label = "ranges [%]",
          .series = next_to_even(bins, 1e-3)};
}

Plot edge_plot(const std::string& name, const Crossings& edges) {
  constexpr std::size_t kBins = 10;
  statistics::Histogram bins(0, 1, kBins);
  for (const double place : edges.places) bins.add(place);
  return {.title = fmt::format("{}: {:.1f} % of {} edges with a mixed pixel", name, 100 * edges.share(),
                               edges.mixed.size()),
          .x_label = "relative position from the near side to the far side",
          .y_label = "mixed pixels [%]",
          .series = next_to_even(bins, 1)};
}

Plot moving_plot(const ChangingDirections& directions) {
  PlotSeries hidden{.name = "occluded", .x = {}, .y = {}};
  const std::size_t whens = directions.views.empty() ? 0 : directions.views.front().size();
  for (std::size_t when = 0; when < whens; ++when) {
    const auto count = std::ranges::count_if(
        directions.views, [&](const auto& views) { return views[when] == Visibility::kHidden; });
    hidden.x.push_back(static_cast<double>(when));
    hidden.y.push_back(static_cast<double>(count));
  }
  return {.title = fmt::format("{} directions that are occluded at times", directions.views.size()),
          .x_label = "half turns of the plate",
          .y_label = "directions",
          .series = {hidden}};
}

}  // namespace crisp::diagnose
