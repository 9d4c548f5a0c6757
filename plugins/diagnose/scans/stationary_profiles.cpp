// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/stationary_profiles.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {

std::vector<double> row_of(const SeriesScan& scan) {
  std::vector<double> row(scan.ranges().begin(), scan.ranges().end());
  for (double& range : row) {
    if (!(range > 0)) range = std::nan("");
  }
  return row;
}

std::vector<double> mean_profile(const std::vector<SeriesScan>& scans) {
  std::vector<std::vector<double>> rows;
  for (const auto& scan : scans) rows.push_back(row_of(scan));
  return mean_profile(rows);
}

std::vector<double> mean_profile(const std::vector<std::vector<double>>& rows) {
  constexpr double kNear = 0.1;  // [m]
  std::size_t beams = 0;
  for (const auto& row : rows) beams = std::max(beams, row.size());
  std::vector<double> profile(beams, std::nan(""));
  std::vector<double> values;
  for (std::size_t k = 0; k < beams; ++k) {
    values.clear();
    for (const auto& row : rows) {
      if (k < row.size() && std::isfinite(row[k])) values.push_back(row[k]);
    }
    if (values.empty() || 2 * values.size() < rows.size()) continue;
    const double middle = statistics::median_in_place(values);
    double sum = 0;
    double n = 0;
    for (const double value : values) {
      if (std::abs(value - middle) > kNear) continue;
      sum += value;
      n += 1;
    }
    profile[k] = sum / n;
  }
  return profile;
}

double at_beam(const std::vector<double>& profile, double beam) {
  constexpr double kRounding = 1e-9;
  const double floor = std::floor(beam + kRounding);
  const double on = std::max(0.0, beam - floor);
  if (floor < 0 || floor >= static_cast<double>(profile.size())) return std::nan("");
  const auto k = static_cast<std::size_t>(floor);
  if (on < kRounding) return profile[k];
  if (k + 1 >= profile.size()) return std::nan("");
  return (1 - on) * profile[k] + on * profile[k + 1];
}

}  // namespace crisp::diagnose
