// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_weights.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipeline/data/middle.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/plane.hpp"

namespace crisp {
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

/// One for each view, to be added.
struct AllViewSums : std::vector<ViewSums> {
  using std::vector<ViewSums>::vector;
  AllViewSums& operator+=(const AllViewSums& other) {
    for (std::size_t v = 0; v < size(); ++v) (*this)[v] += other[v];
    return *this;
  }
};

/// The plane of each view's own.
std::vector<Eigen::Vector3d> planes_of(const Views& views, const std::vector<SurfelResidual>& residuals) {
  const auto add = [&](AllViewSums& sums, std::size_t begin, std::size_t end) {
    views.for_runs(begin, end, [&](std::uint32_t view, std::size_t first, std::size_t last) {
      ViewSums sum = sums[view];
      for (std::size_t i = first; i < last; ++i) {
        const SurfelResidual& r = residuals[i];
        sum.add(r.u, r.v, r.distance, r.weight / (r.spread * r.spread));
      }
      sums[view] = sum;
    });
  };
  std::vector<Eigen::Vector3d> planes;
  for (const ViewSums& sums :
       sum_over_blocks(residuals.size(), kResidualBlock, AllViewSums(views.count), add)) {
    planes.push_back(sums.count() > 0 ? sums.fit() : Eigen::Vector3d::Zero());
  }
  return planes;
}

/// What is left of each distance [spreads] after the plane of its view's own.
std::vector<double> within_views(const Views& views, const std::vector<SurfelResidual>& residuals) {
  const auto planes = planes_of(views, residuals);
  std::vector<double> left(residuals.size());
  for_blocks(residuals.size(), kResidualBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    views.for_runs(begin, end, [&](std::uint32_t view, std::size_t first, std::size_t last) {
      const Eigen::Vector3d plane = planes[view];
      for (std::size_t i = first; i < last; ++i) {
        const SurfelResidual& r = residuals[i];
        left[i] = (r.distance - plane.dot(Eigen::Vector3d(1, r.u, r.v))) / r.spread;
      }
    });
  });
  return left;
}

/// By how much more the residuals scatter than they should; 1 where it is no more.
double excess(std::vector<double> left) {
  constexpr double kNormal = 1.4826;  // standard deviation of what is normal, in medians of its size
  for (double& value : left) value = kNormal * std::abs(value);
  // That most are small enough is mostly so, and sooner told than where the median is.
  const auto small = std::ranges::count_if(left, [](double value) { return value <= 1; });
  if (static_cast<std::size_t>(small) > left.size() / 2) return 1;
  return std::max(1.0, middle_of(left));
}

/// Sets the weights by Tukey's biweight; wider where the noise is.
void weigh_each(double outlier, const Views& views, std::vector<SurfelResidual>& residuals) {
  constexpr int kRounds = 3;  // enough for the few per cent of outliers of a room
  for (int round = 0; round < kRounds; ++round) {
    const auto left = within_views(views, residuals);
    const double end = outlier * excess(left);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (residuals[i].grazes()) continue;
      const double x = std::min(1.0, std::abs(left[i]) / end);
      residuals[i].weight = (1 - x * x) * (1 - x * x);
    }
  }
}

Eigen::AlignedBox2d box_of(const std::vector<SurfelResidual>& residuals) {
  Eigen::AlignedBox2d box;
  for (const SurfelResidual& r : residuals) box.extend(Eigen::Vector2d(r.u, r.v));
  return box;
}

/// Rectangular cells over a box in a surfel's plane.
class CellsOnPlane {
 public:
  CellsOnPlane(const Eigen::AlignedBox2d& box, double along_u, double along_v)
      : sides_(along_u, along_v),
        low_(box.min()),
        columns_(along(0, box.max().x()) + 1),
        count_(columns_ * (along(1, box.max().y()) + 1)) {}
  std::size_t count() const { return count_; }
  std::size_t of(const SurfelResidual& r) const { return along(1, r.v) * columns_ + along(0, r.u); }

 private:
  std::size_t along(Eigen::Index axis, double at) const {
    return static_cast<std::size_t>((at - low_[axis]) / sides_[axis]);
  }

  Eigen::Vector2d sides_;
  Eigen::Vector2d low_;
  std::size_t columns_ = 0;
  std::size_t count_ = 0;
};

/// What beams in one cell miss the planes of their views by.
struct CellSum {
  double sum = 0;  // [spreads]
  double count = 0;

  /// By more than chance and more than bumps explain.
  bool is_strange() const {
    constexpr double kChance = 3;  // standard deviations of the mean
    constexpr double kBump = 0.3;  // [spreads]
    const double n = std::max(1.0, count);
    return std::abs(sum) / n > std::max(kBump, kChance / std::sqrt(n));
  }
};

/// Leaves out what lies in strange cells.
void leave_out_strange(const CellsOnPlane& cells, const Views& views,
                       std::vector<SurfelResidual>& residuals) {
  const auto left = within_views(views, residuals);
  std::vector<std::size_t> cell_of(residuals.size());
  std::vector<CellSum> sums(cells.count());
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    cell_of[i] = cells.of(residuals[i]);
    if (residuals[i].weight == 0) continue;
    sums[cell_of[i]].sum += left[i];
    sums[cell_of[i]].count += 1;
  }
  std::vector<char> is_strange(cells.count());
  std::ranges::transform(sums, is_strange.begin(), &CellSum::is_strange);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (is_strange[cell_of[i]]) residuals[i].weight = 0;
  }
}

}  // namespace

void weigh(std::vector<SurfelResidual>& residuals, std::span<const std::uint32_t> members,
           std::span<const std::uint32_t> views, double outlier) {
  const Views numbered = views_of(members, views);
  weigh_each(outlier, numbered, residuals);
  // Beams that met something else within the noise of the plane, an edge of it or what stands before it, come
  // in patches and in narrow strips, mostly along the borders.
  constexpr double kPatch = 0.1;     // [m]
  constexpr double kStrip = 0.5;     // [m] long
  constexpr double kNarrow = 0.025;  // [m] wide
  const Eigen::AlignedBox2d box = box_of(residuals);
  leave_out_strange({box, kPatch, kPatch}, numbered, residuals);
  leave_out_strange({box, kStrip, kNarrow}, numbered, residuals);
  leave_out_strange({box, kNarrow, kStrip}, numbered, residuals);
}

}  // namespace crisp
