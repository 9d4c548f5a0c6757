// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/projection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::write {
namespace {

constexpr double kFieldOfView = 0.9;  // [rad] of the width, in perspective

/// Azimuth and elevation [rad] of the eye, seen from the centre.
std::array<double, 2> eye_of(const PictureSettings& settings) {
  constexpr double kQuarter = std::numbers::pi / 2;
  switch (settings.view) {
    case PictureView::top:
      return {-kQuarter, kQuarter};
    case PictureView::front:
      return {-kQuarter, 0};
    case PictureView::side:
      return {0, 0};
    case PictureView::perspective:
      break;
  }
  return {settings.azimuth, settings.elevation};
}

std::array<std::array<double, 3>, 3> axes_of(const PictureSettings& settings) {
  const auto [azimuth, elevation] = eye_of(settings);
  const double ca = std::cos(azimuth), sa = std::sin(azimuth);
  const double ce = std::cos(elevation), se = std::sin(elevation);
  return {{{-sa, ca, 0}, {-se * ca, -se * sa, ce}, {ce * ca, ce * sa, se}}};
}

/// [m] Centre and extent of the values between the 1st and the 99th percentile.
struct Spread {
  double centre = 0, extent = 0;
};

Spread spread_of(std::vector<double>& values) {
  if (values.empty()) return {};
  const double low = statistics::quantile_in_place(values, 0.01),
               high = statistics::quantile_in_place(values, 0.99);
  return {.centre = (low + high) / 2, .extent = high - low};
}

}  // namespace

double round_above(double value) {
  constexpr std::array<double, 10> kSteps{1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10};
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : kSteps) {
    if (step * decade >= value * (1 - 1e-9)) return step * decade;
  }
  return 10 * decade;
}

PictureProjection::PictureProjection(const PictureSettings& settings, const std::vector<PicturePoint>& points)
    : settings_(settings), axes_(axes_of(settings)) {
  fit(points);
}

void PictureProjection::fit(const std::vector<PicturePoint>& points) {
  const bool is_perspective = settings_.view == PictureView::perspective;
  const double margin = is_perspective ? 1.3 : 1.05;  // what is near looks larger
  constexpr double kMin = 0.1;                        // [m] of the view, however few points there are
  std::array<std::vector<double>, 3> coordinates;
  for (const PicturePoint& point : points) {
    if (!is_deep_enough(point)) continue;
    const auto seen = in_view(point);
    for (std::size_t k = 0; k < 3; ++k) coordinates[k].push_back(seen[k]);
  }
  const Spread right = spread_of(coordinates[0]), up = spread_of(coordinates[1]);
  const double shape = static_cast<double>(settings_.width) / settings_.height;
  across_ =
      settings_.across.value_or(round_above(margin * std::max({right.extent, up.extent * shape, kMin})));
  // Clouds that differ little, as before and after a calibration, get the same centre.
  const double step = across_ / 20;
  centre_ = settings_.centre.value_or(
      std::array{step * std::round(right.centre / step), step * std::round(up.centre / step)});
  depth_ = spread_of(coordinates[2]).centre;
  distance_ = across_ / (2 * std::tan(kFieldOfView / 2));
}

std::array<double, 3> PictureProjection::in_view(const PicturePoint& point) const {
  std::array<double, 3> seen{};
  for (std::size_t k = 0; k < 3; ++k) {
    seen[k] = axes_[k][0] * double{point.x} + axes_[k][1] * double{point.y} + axes_[k][2] * double{point.z};
  }
  return seen;
}

bool PictureProjection::is_deep_enough(const PicturePoint& point) const {
  const bool is_height = settings_.view == PictureView::top || settings_.view == PictureView::perspective;
  const float depth = is_height ? point.z : settings_.view == PictureView::front ? point.y : point.x;
  return double{depth} >= settings_.depth[0] && double{depth} <= settings_.depth[1];
}

std::optional<std::array<std::uint32_t, 2>> PictureProjection::pixel(const PicturePoint& point) const {
  if (!is_deep_enough(point)) return std::nullopt;
  const auto [right, up, towards] = in_view(point);
  double scale = settings_.width / across_;
  if (settings_.view == PictureView::perspective) {
    const double from_eye = depth_ + distance_ - towards;
    if (from_eye < 1e-3 * distance_) return std::nullopt;
    scale *= distance_ / from_eye;
  }
  const double column = settings_.width / 2.0 + (right - centre_[0]) * scale;
  const double row = settings_.height / 2.0 - (up - centre_[1]) * scale;
  if (!(column >= 0 && column < settings_.width && row >= 0 && row < settings_.height)) return std::nullopt;
  return std::array{static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row)};
}

}  // namespace crisp::write
