// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/trend.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "pipeline/statistics/multiple_testing.hpp"

namespace crisp::batch {
namespace {

constexpr std::size_t kMin = 3;  // recordings that make a trend

double difference(double value, double from, const std::string& unit) {
  return unit == "rad" ? std::remainder(value - from, 2 * std::numbers::pi) : value - from;
}

double weight_of(const TrendPoint& point) { return 1 / (point.std_error * point.std_error); }

/// Weighted median of the differences from the first value.
double weighted_median(const std::vector<TrendPoint>& points, const std::string& unit) {
  const double first = points.front().value;
  std::vector<std::pair<double, double>> weighted;  // difference, weight
  double total = 0;
  for (const auto& point : points) {
    weighted.emplace_back(difference(point.value, first, unit), weight_of(point));
    total += weighted.back().second;
  }
  std::ranges::sort(weighted);
  double below = 0;
  for (const auto& [value, weight] : weighted) {
    below += weight;
    if (below >= total / 2) return first + value;
  }
  return first;
}

double sum_of_weights(const std::vector<TrendPoint>& points) {
  return std::accumulate(points.begin(), points.end(), 0.0,
                         [](double sum, const TrendPoint& point) { return sum + weight_of(point); });
}

/// @param tests  of all parameters and recordings
void judge(ParameterTrend& trend, std::size_t tests) {
  // Asymptotic efficiency of the median of normal values: 2/π.
  constexpr double kOfMedian = std::numbers::pi / 2;
  trend.centre = weighted_median(trend.points, trend.unit);
  trend.centre_error = std::sqrt(kOfMedian / sum_of_weights(trend.points));
  for (auto& point : trend.points) {
    const double distance = difference(point.value, trend.centre, trend.unit);
    trend.chi2 += distance * distance * weight_of(point);
    const double z = distance / std::hypot(point.std_error, trend.centre_error);
    point.p_value =
        statistics::sidak_p_value(static_cast<double>(tests), std::erfc(std::abs(z) / std::numbers::sqrt2));
  }
  trend.chi2 /= static_cast<double>(trend.points.size() - 1);
}

/// Trusted rows in the order of the recordings' time.
std::vector<const BatchRow*> trusted_by_time(const std::vector<BatchRow>& rows) {
  std::vector<const BatchRow*> trusted;
  for (const auto& row : rows) {
    if (row.status == "done") trusted.push_back(&row);
  }
  std::ranges::stable_sort(trusted, {}, [](const BatchRow* row) { return row->begin.value_or(0); });
  return trusted;
}

}  // namespace

std::vector<ParameterTrend> batch_trend(const std::vector<BatchRow>& rows) {
  std::map<std::string, ParameterTrend> by_name;
  for (const BatchRow* row : trusted_by_time(rows)) {
    for (const auto& [name, parameter] : row->parameters) {
      const double error = parameter.std_error.value_or(0);
      if (!(error > 0) || !std::isfinite(error) || !std::isfinite(parameter.value)) continue;
      ParameterTrend& trend = by_name[name];
      trend.name = name;
      trend.unit = parameter.unit;
      trend.points.push_back({.recording = row->name, .value = parameter.value, .std_error = error});
    }
  }
  std::erase_if(by_name, [](const auto& each) { return each.second.points.size() < kMin; });
  std::size_t tests = 0;
  for (const auto& [name, trend] : by_name) tests += trend.points.size();
  std::vector<ParameterTrend> trends;
  for (auto& [name, trend] : by_name) {
    judge(trend, tests);
    trends.push_back(std::move(trend));
  }
  return trends;
}

void mark_outstanding(const std::vector<ParameterTrend>& trends, std::vector<BatchRow>& rows) {
  std::unordered_map<std::string_view, BatchRow*> by_name;
  for (auto& row : rows) by_name[row.name] = &row;
  for (const auto& trend : trends) {
    for (const auto& point : trend.points) {
      if (point.p_value < kStandsOut) by_name.at(point.recording)->stands_out.push_back(trend.name);
    }
  }
}

}  // namespace crisp::batch
