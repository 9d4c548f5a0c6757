// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/measure.hpp>

#include "example.hpp"

namespace {

/// How far the points lie from their mean: Σ (x − x̄)² / n [m²].
class Spread final : public crisp::Measure {
 public:
  crisp::Quality evaluate(const crisp::PointsView& points, std::span<const double>, double,
                          bool gradient) override {
    const auto n = static_cast<double>(points.size());
    crisp::Quality quality;
    if (gradient) quality.gradient.assign(points.size(), 0);
    const auto add = [&](std::span<const double> values, std::vector<double>& derivatives) {
      double mean = 0;
      for (const double value : values) mean += value / n;
      for (std::size_t i = 0; i < values.size(); ++i) {
        quality.value += (values[i] - mean) * (values[i] - mean) / n;
        if (gradient) derivatives[i] = 2 * (values[i] - mean) / n;
      }
    };
    add(points.x, quality.gradient.x);
    add(points.y, quality.gradient.y);
    add(points.z, quality.gradient.z);
    return quality;
  }
};

}  // namespace

void register_spread_measure(crisp::Registrar& registrar) {
  registrar.get<crisp::MeasureRegistry>().add(
      "example.spread", "mean squared distance from the mean",
      [](const auto&, const auto&) { return std::make_unique<Spread>(); });
}
