// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_residuals.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipeline/data/middle.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/plane.hpp"

namespace crisp {
namespace {

constexpr std::size_t kBlock = 8192;  // beams
constexpr double kGrazing = 0.05;     // cosine of the incidence below which a beam runs along the plane

SurfelResidual against(const Surfel& surfel, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                       const SurfelSettings& settings) {
  SurfelResidual r;
  const Eigen::Vector3d offset = point - surfel.middle;
  r.incidence = surfel.normal.dot(direction);
  r.distance = surfel.normal.dot(offset);
  r.spread = std::hypot(settings.noise * r.incidence, settings.floor);
  if (std::abs(r.incidence) >= kGrazing) {
    r.weight = 1;
    r.range_change = -r.distance / r.incidence;
  }
  const Eigen::Vector3d foot = offset + r.range_change * direction;
  r.u = surfel.u.dot(foot);
  r.v = surfel.v.dot(foot);
  return r;
}

/// What a plane near the surfel's is made of: its distance is a multiple of each.
Eigen::Vector3d basis(const Surfel& surfel, const SurfelResidual& r) {
  return {1, r.u / surfel.radius, r.v / surfel.radius};
}

/// Σ over the residuals, made a block at a time.
template <class Sum, class Add>
Sum sum_over(std::size_t n, const Sum& zero, const Add& add) {
  std::vector<Sum> blocks(blocks_of(n, kBlock), zero);
  for_blocks(n, kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) add(blocks[block], i);
  });
  Sum total = zero;
  for (const Sum& block : blocks) total += block;
  return total;
}

Eigen::Vector3d fit(const Surfel& surfel, const std::vector<SurfelResidual>& residuals) {
  using Sum = Eigen::Matrix<double, 3, 4>;  // the normal equations, right side last
  const Sum sum = sum_over(residuals.size(), Sum(Sum::Zero()), [&](Sum& block, std::size_t i) {
    const SurfelResidual& r = residuals[i];
    const Eigen::Vector3d row = basis(surfel, r);
    Eigen::Vector4d with_distance;
    with_distance << row, r.distance;
    block += r.weight / (r.spread * r.spread) * row * with_distance.transpose();
  });
  return sum.leftCols<3>().completeOrthogonalDecomposition().solve(sum.col(3));
}

/// The beams' views, numbered from 0.
struct Views {
  std::vector<std::uint32_t> known;
  std::vector<std::size_t> of;  // each beam
};

Views views_of(std::span<const std::uint32_t> members, const BeamsView& beams) {
  Views views;
  for (const std::uint32_t i : members) {
    const std::uint32_t view = beams.views.empty() ? 0 : beams.views[i];
    const auto found = std::ranges::find(views.known, view);
    views.of.push_back(static_cast<std::size_t>(found - views.known.begin()));
    if (found == views.known.end()) views.known.push_back(view);
  }
  return views;
}

/// One for each view, to be added.
struct AllViewSums : std::vector<ViewSums> {
  using std::vector<ViewSums>::vector;
  AllViewSums& operator+=(const AllViewSums& other) {
    for (std::size_t v = 0; v < size(); ++v) (*this)[v] += other[v];
    return *this;
  }
};

/// What is left of each distance [spreads] after a plane of its view's own: however much views disagree, an
/// outlier is what its own view contradicts.
std::vector<double> within_views(const std::vector<SurfelResidual>& residuals, const Views& views) {
  const auto sums =
      sum_over(residuals.size(), AllViewSums(views.known.size()), [&](auto& block, std::size_t i) {
        const SurfelResidual& r = residuals[i];
        if (r.weight > 0) block[views.of[i]].add(r.u, r.v, r.distance, r.weight / (r.spread * r.spread));
      });
  std::vector<Eigen::Vector3d> planes;
  for (const ViewSums& view : sums) planes.push_back(view.count > 0 ? view.fit() : Eigen::Vector3d::Zero());
  std::vector<double> left(residuals.size());
  for_blocks(residuals.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfelResidual& r = residuals[i];
      left[i] = (r.distance - planes[views.of[i]].dot(Eigen::Vector3d(1, r.u, r.v))) / r.spread;
    }
  });
  return left;
}

double median_size(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return middle_of(values);
}

/// Sets the weights by Tukey's biweight; wider where the noise is.
void weigh(double outlier, const Views& views, std::vector<SurfelResidual>& residuals) {
  constexpr int kRounds = 3;  // enough for the few per cent of outliers of a room
  for (int round = 0; round < kRounds; ++round) {
    const auto left = within_views(residuals, views);
    const double end = outlier * std::max(1.0, 1.4826 * median_size(left));
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (std::abs(residuals[i].incidence) < kGrazing) continue;
      const double x = std::min(1.0, std::abs(left[i]) / end);
      residuals[i].weight = (1 - x * x) * (1 - x * x);
    }
  }
}

/// Rectangular cells over a surfel's plane.
class CellsOnPlane {
 public:
  CellsOnPlane(const std::vector<SurfelResidual>& residuals, double along_u, double along_v)
      : sides_(along_u, along_v),
        box_(box_of(residuals)),
        columns_(along(0, box_.max().x()) + 1),
        count_(columns_ * (along(1, box_.max().y()) + 1)) {}
  std::size_t count() const { return count_; }
  std::size_t of(const SurfelResidual& r) const { return along(1, r.v) * columns_ + along(0, r.u); }

 private:
  std::size_t along(Eigen::Index axis, double at) const {
    return static_cast<std::size_t>((at - box_.min()[axis]) / sides_[axis]);
  }
  static Eigen::AlignedBox2d box_of(const std::vector<SurfelResidual>& residuals) {
    Eigen::AlignedBox2d box;
    for (const SurfelResidual& r : residuals) box.extend(Eigen::Vector2d(r.u, r.v));
    return box;
  }

  Eigen::Vector2d sides_;
  Eigen::AlignedBox2d box_;
  std::size_t columns_ = 0;
  std::size_t count_ = 0;
};

/// Leaves out the cells in which beams miss the planes of their views by more than chance and more than bumps
/// explain.
void leave_out_strange_cells(const Views& views, double along_u, double along_v,
                             std::vector<SurfelResidual>& residuals) {
  constexpr double kChance = 3;  // standard deviations of a cell's mean
  constexpr double kBump = 0.3;  // [spreads]
  const auto left = within_views(residuals, views);
  const CellsOnPlane cells(residuals, along_u, along_v);
  std::vector<double> sum(cells.count(), 0);
  std::vector<double> count(cells.count(), 0);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i].weight == 0) continue;
    sum[cells.of(residuals[i])] += left[i];
    count[cells.of(residuals[i])] += 1;
  }
  for (SurfelResidual& r : residuals) {
    const std::size_t cell = cells.of(r);
    const double n = std::max(1.0, count[cell]);
    if (std::abs(sum[cell]) / n > std::max(kBump, kChance / std::sqrt(n))) r.weight = 0;
  }
}

/// Beams that met something else within the noise of the plane, an edge of it or what stands before it, come
/// in patches and in narrow strips, mostly along the borders.
void leave_out_strangers(const Views& views, std::vector<SurfelResidual>& residuals) {
  constexpr double kPatch = 0.1;     // [m]
  constexpr double kStrip = 0.5;     // [m] long
  constexpr double kNarrow = 0.025;  // [m] wide
  leave_out_strange_cells(views, kPatch, kPatch, residuals);
  leave_out_strange_cells(views, kStrip, kNarrow, residuals);
  leave_out_strange_cells(views, kNarrow, kStrip, residuals);
}

/// The residuals from the surfel's own plane.
std::vector<SurfelResidual> from_own_plane(const Surfel& surfel, std::span<const std::uint32_t> members,
                                           const BeamsView& beams, const SurfelSettings& settings) {
  std::vector<SurfelResidual> residuals(members.size());
  for_blocks(members.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = members[k];
      const Eigen::Vector3d point(beams.points.x[i], beams.points.y[i], beams.points.z[i]);
      const Eigen::Vector3d direction(beams.directions.x[i], beams.directions.y[i], beams.directions.z[i]);
      residuals[k] = against(surfel, point, direction, settings);
    }
  });
  return residuals;
}

}  // namespace

std::vector<SurfelResidual> residuals_of(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
                                         const SurfelSettings& settings) {
  auto residuals = from_own_plane(surfel, surfels.beams_of(surfel), beams, settings);
  for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k].weight = surfels.weights[surfel.begin + k];
  const Eigen::Vector3d plane = fit(surfel, residuals);
  for (SurfelResidual& r : residuals) {
    r.distance -= plane.dot(basis(surfel, r));
    if (std::abs(r.incidence) >= kGrazing) r.range_change = -r.distance / r.incidence;
  }
  return residuals;
}

void refine(Surfel& surfel, Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings) {
  const auto members = surfels.beams_of(surfel);
  auto residuals = from_own_plane(surfel, members, beams, settings);
  if (settings.outlier > 0) {
    const Views views = views_of(members, beams);
    weigh(settings.outlier, views, residuals);
    leave_out_strangers(views, residuals);
  }
  for (std::size_t k = 0; k < residuals.size(); ++k) surfels.weights[surfel.begin + k] = residuals[k].weight;
  const Eigen::Vector3d plane = fit(surfel, residuals);
  surfel.middle += plane[0] * surfel.normal;
  surfel.normal = (surfel.normal - (plane[1] * surfel.u + plane[2] * surfel.v) / surfel.radius).normalized();
  surfel.v = surfel.normal.cross(surfel.u).normalized();
  surfel.u = surfel.v.cross(surfel.normal);
}

}  // namespace crisp
