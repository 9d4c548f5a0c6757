// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_weights.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/plane.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::quality {
namespace {

/// The beams' views, numbered from 0.
struct Views {
  std::size_t count = 0;
  std::vector<std::uint32_t> of;  // each beam

  /// Calls visit(view, first, last) for the runs of one view that make up begin … end − 1. The beams of a
  /// scan are many in a row.
  template <class Visit>
  void for_runs(std::size_t begin, std::size_t end, const Visit& visit) const {
    for (std::size_t first = begin; first < end;) {
      std::size_t last = first + 1;
      while (last < end && of[last] == of[first]) ++last;
      visit(of[first], first, last);
      first = last;
    }
  }
};

Views views_of(std::span<const std::uint32_t> members, std::span<const std::uint32_t> views) {
  if (views.empty()) return {.count = 1, .of = std::vector<std::uint32_t>(members.size(), 0)};
  Views result{.count = 0, .of = std::vector<std::uint32_t>(members.size())};
  std::vector<std::uint32_t> known;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::uint32_t view = views[members[k]];
    if (k > 0 && view == views[members[k - 1]]) {
      result.of[k] = result.of[k - 1];
      continue;
    }
    const auto found = std::ranges::find(known, view);
    result.of[k] = static_cast<std::uint32_t>(found - known.begin());
    if (found == known.end()) known.push_back(view);
  }
  result.count = known.size();
  return result;
}

/// Columns of the residuals for repeated passes.
struct Weighing {
  explicit Weighing(const std::vector<SurfelResidual>& residuals) {
    for (auto* column : {&u, &v, &distance, &per_spread, &most, &weight}) column->reserve(residuals.size());
    for (const SurfelResidual& r : residuals) {
      u.push_back(r.u);
      v.push_back(r.v);
      distance.push_back(r.distance);
      per_spread.push_back(1 / r.spread);
      most.push_back(r.weight);
      weight.push_back(r.weight);
    }
  }
  std::size_t size() const { return u.size(); }

  std::vector<double> u, v, distance;  // [m]
  std::vector<double> per_spread;      // [1/m]
  std::vector<double> most;            // 1; 0 for beams that never count
  std::vector<double> weight;
};

/// One for each view, to be added.
struct AllViewSums : std::vector<ViewSums> {
  using std::vector<ViewSums>::vector;
  AllViewSums& operator+=(const AllViewSums& other) {
    for (std::size_t v = 0; v < size(); ++v) (*this)[v] += other[v];
    return *this;
  }
};

/// The plane of each view's own.
std::vector<Eigen::Vector3d> planes_of(const Views& views, const Weighing& of) {
  const auto add = [&](AllViewSums& sums, std::size_t begin, std::size_t end) {
    views.for_runs(begin, end, [&](std::uint32_t view, std::size_t first, std::size_t last) {
      ViewSums sum = sums[view];
      for (std::size_t i = first; i < last; ++i) {
        sum.add(of.u[i], of.v[i], of.distance[i], of.weight[i] * of.per_spread[i] * of.per_spread[i]);
      }
      sums[view] = sum;
    });
  };
  std::vector<Eigen::Vector3d> planes;
  for (const ViewSums& sums : sum_over_blocks(of.size(), kResidualBlock, AllViewSums(views.count), add)) {
    planes.push_back(sums.count() > 0 ? sums.fit() : Eigen::Vector3d::Zero());
  }
  return planes;
}

/// The residual of each distance [spreads] after the plane of its own view.
std::vector<double> within_views(const Views& views, const Weighing& of) {
  const auto planes = planes_of(views, of);
  std::vector<double> left(of.size());
  for_blocks(of.size(), kResidualBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    views.for_runs(begin, end, [&](std::uint32_t view, std::size_t first, std::size_t last) {
      const double middle = planes[view][0];
      const double along_u = planes[view][1];
      const double along_v = planes[view][2];
      for (std::size_t i = first; i < last; ++i) {
        left[i] = (of.distance[i] - middle - along_u * of.u[i] - along_v * of.v[i]) * of.per_spread[i];
      }
    });
  });
  return left;
}

/// Ratio of the residuals' scatter to the expected one; 1 where it is no larger.
double excess(const std::vector<double>& left) {
  const auto size = [](double value) { return statistics::kMadToSigma * std::abs(value); };
  // Most are small enough, as a rule, which is found sooner than the median.
  const auto small = std::ranges::count_if(
      left, [](double value) { return value <= 1; }, size);
  if (static_cast<std::size_t>(small) > left.size() / 2) return 1;
  std::vector<double> sizes(left.size());
  std::ranges::transform(left, sizes.begin(), size);
  return std::max(1.0, statistics::median_in_place(sizes));
}

/// Tukey's biweight; wider where the noise is.
void weigh_each(double outlier, const Views& views, Weighing& of) {
  constexpr int kRounds = 3;  // enough for the few per cent of outliers of a room
  for (int round = 0; round < kRounds; ++round) {
    const auto left = within_views(views, of);
    const double per_end = 1 / (outlier * excess(left));
    for (std::size_t i = 0; i < of.size(); ++i) {
      of.weight[i] = of.most[i] * statistics::biweight(left[i] * per_end);
    }
  }
}

/// Rectangular cells over all places in a surfel's plane.
class CellsOnPlane {
 public:
  CellsOnPlane(const Weighing& of, double along_u, double along_v)
      : u_(along(of.u, along_u)), v_(along(of.v, along_v)) {}

  std::size_t count() const { return u_.count * v_.count; }
  std::size_t of(double u, double v) const { return v_.of(v) * u_.count + u_.of(u); }

 private:
  struct Axis {
    double low = 0;   // [m]
    double side = 1;  // [m]
    std::size_t count = 0;
    std::size_t of(double at) const { return static_cast<std::uint32_t>((at - low) / side); }
  };
  static Axis along(const std::vector<double>& places, double side) {
    const auto [low, high] = std::ranges::minmax(places);
    Axis axis{.low = low, .side = side};
    axis.count = axis.of(high) + 1;
    return axis;
  }

  Axis u_;
  Axis v_;
};

/// Sums of the residuals of beams in one cell against the planes of their views.
struct CellSum {
  double sum = 0;  // [spreads]
  double count = 0;

  /// By more than chance and more than bumps explain.
  bool is_outlier() const {
    constexpr double kChance = 3;  // standard deviations of the mean
    constexpr double kBump = 0.3;  // [spreads]
    const double n = std::max(1.0, count);
    return std::abs(sum) / n > std::max(kBump, kChance / std::sqrt(n));
  }
};

/// Leaves out what lies in strange cells.
void reject_outliers(const CellsOnPlane& cells, const Views& views, Weighing& of) {
  const auto left = within_views(views, of);
  std::vector<std::size_t> cell_of(of.size());
  std::vector<CellSum> sums(cells.count());
  for (std::size_t i = 0; i < of.size(); ++i) {
    cell_of[i] = cells.of(of.u[i], of.v[i]);
    if (of.weight[i] == 0) continue;
    sums[cell_of[i]].sum += left[i];
    sums[cell_of[i]].count += 1;
  }
  std::vector<char> is_outlier(cells.count());
  std::ranges::transform(sums, is_outlier.begin(), &CellSum::is_outlier);
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (is_outlier[cell_of[i]]) of.weight[i] = 0;
  }
}

}  // namespace

void weigh(std::vector<SurfelResidual>& residuals, std::span<const std::uint32_t> members,
           std::span<const std::uint32_t> views, double outlier) {
  if (residuals.empty()) return;
  const Views numbered = views_of(members, views);
  Weighing weighing(residuals);
  weigh_each(outlier, numbered, weighing);
  // Beams that met something else within the noise of the plane, an edge of it or what stands before it, come
  // in patches and in narrow strips, mostly along the borders.
  constexpr double kPatch = 0.1;     // [m]
  constexpr double kStrip = 0.5;     // [m] long
  constexpr double kNarrow = 0.025;  // [m] wide
  reject_outliers({weighing, kPatch, kPatch}, numbered, weighing);
  reject_outliers({weighing, kStrip, kNarrow}, numbered, weighing);
  reject_outliers({weighing, kNarrow, kStrip}, numbered, weighing);
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i].weight = weighing.weight[i];
}

}  // namespace crisp::quality
