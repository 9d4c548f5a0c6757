// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/plot/axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crisp::plot {
namespace {

/// The least and the most of some values.
class Span {
 public:
  void add(double value) {
    least_ = std::min(least_, value);
    most_ = std::max(most_, value);
  }
  bool is_empty() const { return least_ > most_; }
  double least() const { return is_empty() ? 0 : least_; }
  double most() const { return is_empty() ? 1 : most_; }

 private:
  double least_ = std::numeric_limits<double>::infinity();
  double most_ = -std::numeric_limits<double>::infinity();
};

/// Calls point(series, i) for all points that have a place.
template <class Point>
void for_each_shown(const Plot& plot, Point point) {
  for (const PlotSeries& series : plot.series) {
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (is_shown(plot, series.x[i], series.y[i])) point(series, i);
    }
  }
}

}  // namespace

PlotAxis::PlotAxis(double least, double most, double first_pixel, double last_pixel, PlotScale scale)
    : scale_(scale), first_pixel_(first_pixel), last_pixel_(last_pixel) {
  if (scale == PlotScale::logarithmic) {
    least = std::log10(least);
    most = std::log10(most);
  }
  if (!(most > least)) most = least + 1;
  constexpr double kRoom = 0.04;
  least_ = least - kRoom * (most - least);
  most_ = most + kRoom * (most - least);
}

double PlotAxis::pixel(double value) const {
  if (scale_ == PlotScale::logarithmic) value = value > 0 ? std::log10(value) : least_;
  const double way = (std::clamp(value, least_, most_) - least_) / (most_ - least_);
  return first_pixel_ + way * (last_pixel_ - first_pixel_);
}

std::vector<double> PlotAxis::marks() const {
  return scale_ == PlotScale::logarithmic ? decades() : round_values();
}

std::vector<double> PlotAxis::round_values() const {
  constexpr double kMarks = 6;
  const double rough = (most_ - least_) / kMarks;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double nice : {1.0, 2.0, 5.0}) {
    if (nice * power >= rough) {
      step = nice * power;
      break;
    }
  }
  std::vector<double> all;
  const auto first = static_cast<long>(std::ceil(least_ / step)),
             last = static_cast<long>(std::floor(most_ / step));
  for (long i = first; i <= last; ++i) all.push_back(static_cast<double>(i) * step);
  return all;
}

std::vector<double> PlotAxis::decades() const {
  constexpr double kFew = 3;
  std::vector<double> all;
  for (double power = std::floor(least_); power <= most_; ++power) {
    for (const double part : {1.0, 2.0, 5.0}) {
      const double lg = power + std::log10(part);
      const bool is_requested = part == 1 || most_ - least_ < kFew;
      if (is_requested && lg >= least_ && lg <= most_) all.push_back(part * std::pow(10.0, power));
    }
  }
  return all;
}

double error_at(const PlotSeries& series, std::size_t i) {
  return i < series.error.size() && std::isfinite(series.error[i]) ? series.error[i] : 0;
}

bool is_shown(const Plot& plot, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (plot.y_scale == PlotScale::linear || y > 0);
}

PlotAxis horizontal_axis(const Plot& plot, double first_pixel, double last_pixel) {
  constexpr double kHalfAKind = 0.5;
  Span span;
  for_each_shown(plot, [&](const PlotSeries& series, std::size_t i) { span.add(series.x[i]); });
  for (const PlotKind& kind : plot.kinds) {
    span.add(kind.at - kHalfAKind);
    span.add(kind.at + kHalfAKind);
  }
  for (const PlotMark& mark : plot.marks) {
    span.add(mark.at - mark.around);
    span.add(mark.at + mark.around);
  }
  return {span.least(), span.most(), first_pixel, last_pixel};
}

PlotAxis vertical_axis(const Plot& plot, double first_pixel, double last_pixel) {
  Span span;
  for_each_shown(plot, [&](const PlotSeries& series, std::size_t i) {
    const double around = error_at(series, i);
    span.add(series.y[i] + around);
    // For small counts the logarithm's bar would reach far below all points.
    span.add(plot.y_scale == PlotScale::logarithmic ? series.y[i] : series.y[i] - around);
  });
  if (span.is_empty()) span.add(1);
  return {span.least(), span.most(), first_pixel, last_pixel, plot.y_scale};
}

}  // namespace crisp::plot
