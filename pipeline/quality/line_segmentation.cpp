// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/line_segmentation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pipeline/quality/segmentation_cost.hpp"

namespace crisp::quality {
namespace {

/// Candidate starts of the run that ends now. In columns, for vector instructions.
class Starts {
 public:
  /// @param price  of all before
  void add(std::size_t place, double price, const LineSums& before) {
    place_.push_back(place);
    const std::array<double, kColumns> row = {before.xx, before.xy,  before.yy, before.x,
                                              before.y,  before.one, price};
    for (std::size_t c = 0; c < kColumns; ++c) column_[c].push_back(row[c]);
    cost_.push_back(0);
  }

  struct Cheapest {
    std::size_t place = 0;
    double cost = 0;
  };
  /// The cheapest segmentation with a run that ends here, without the price of a run.
  Cheapest cheapest(const LineSums& here) {
    const auto& [xx, xy, yy, x, y, one, price] = column_;
    const auto [beginning, cost] =
        simd::run_costs({{xx.data(), xy.data(), yy.data(), x.data(), y.data(), one.data()}, price.data()},
                        {here.xx, here.xy, here.yy, here.x, here.y, here.one}, place_.size(), cost_.data());
    return {place_[beginning], cost};
  }

  /// Forgets the starts that a new one here is better than, whatever comes: a run leaves no less than its
  /// two parts do.
  void forget(double price_here) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < place_.size(); ++k) {
      if (cost_[k] >= price_here) continue;
      place_[kept] = place_[k];
      for (auto& column : column_) column[kept] = column[k];
      ++kept;
    }
    place_.resize(kept);
    cost_.resize(kept);
    for (auto& column : column_) column.resize(kept);
  }

 private:
  static constexpr std::size_t kColumns = 7;
  std::vector<std::size_t> place_;
  std::array<std::vector<double>, kColumns> column_;
  std::vector<double> cost_;
};

}  // namespace

LineSums LineSums::of(double x, double y, double sigma) {
  const double weight = (x * x + y * y) / (sigma * sigma);
  return {weight * x * x, weight * x * y, weight * y * y, weight * x, weight * y, weight};
}

LineSums LineSums::operator+(const LineSums& b) const {
  return {xx + b.xx, xy + b.xy, yy + b.yy, x + b.x, y + b.y, one + b.one};
}

LineSums LineSums::operator-(const LineSums& b) const {
  return {xx - b.xx, xy - b.xy, yy - b.yy, x - b.x, y - b.y, one - b.one};
}

Eigen::Vector2d LineSums::line() const {
  const double determinant = xx * yy - xy * xy;
  if (determinant <= simd::kOneDirection * xx * yy) return Eigen::Vector2d(x, y) / (xx + yy);
  return Eigen::Vector2d(yy * x - xy * y, xx * y - xy * x) / determinant;
}

double LineSums::left() const {
  const double nothing = 0;
  double result = 0;
  simd::run_costs({{&nothing, &nothing, &nothing, &nothing, &nothing, &nothing}, &nothing},
                  {xx, xy, yy, x, y, one}, 1, &result);
  return result;
}

std::vector<std::uint32_t> by_azimuth(const PointsView& points) {
  std::vector<double> azimuth(points.size());
  for (std::size_t i = 0; i < azimuth.size(); ++i) azimuth[i] = std::atan2(points.y[i], points.x[i]);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return azimuth[i]; });
  return order;
}

std::vector<LineSums> running_sums(const PointsView& points, const std::vector<std::uint32_t>& order,
                                   double sigma) {
  std::vector<LineSums> running(1);
  for (const std::uint32_t i : order) {
    running.push_back(running.back() + LineSums::of(points.x[i], points.y[i], sigma));
  }
  return running;
}

std::vector<Run> straight_runs(const std::vector<LineSums>& running, const RunPrices& prices) {
  if (running.empty()) return {};
  const std::size_t n = running.size() - 1;
  std::vector<double> price(n + 1, 0);  // of the best way to cut the points before
  std::vector<std::size_t> begin(n + 1, 0);
  std::vector<bool> is_outlier(n + 1, false);
  Starts starts;
  for (std::size_t end = 1; end <= n; ++end) {
    starts.add(end - 1, price[end - 1], running[end - 1]);
    const auto best = starts.cheapest(running[end]);
    const double with_outlier = price[end - 1] + prices.outlier;
    is_outlier[end] = with_outlier <= best.cost + prices.run;
    price[end] = is_outlier[end] ? with_outlier : best.cost + prices.run;
    begin[end] = is_outlier[end] ? end - 1 : best.place;
    constexpr std::size_t kSometimes = 16;  // moving them together costs more than some needless tests
    if (end % kSometimes == 0) starts.forget(price[end]);
  }
  std::vector<Run> runs;
  for (std::size_t end = n; end > 0; end = begin[end]) {
    if (!is_outlier[end]) runs.push_back({begin[end], end});
  }
  std::ranges::reverse(runs);
  return runs;
}

double price_of(const std::vector<Run>& runs, const std::vector<LineSums>& running, const RunPrices& prices) {
  double price = prices.outlier * static_cast<double>(running.size() - 1);
  for (const Run& run : runs) {
    price += (running[run.end] - running[run.begin]).left() + prices.run -
             prices.outlier * static_cast<double>(run.end - run.begin);
  }
  return price;
}

}  // namespace crisp::quality
