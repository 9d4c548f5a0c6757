// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_residuals.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_weights.hpp"

namespace crisp {
namespace {

SurfelResidual against(const Surfel& surfel, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                       const SurfelSettings& settings) {
  SurfelResidual r;
  const Eigen::Vector3d offset = point - surfel.middle;
  r.incidence = surfel.normal.dot(direction);
  r.distance = surfel.normal.dot(offset);
  r.spread = std::hypot(settings.noise * r.incidence, settings.floor);
  if (!r.grazes()) {
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

Eigen::Vector3d fit(const Surfel& surfel, const std::vector<SurfelResidual>& residuals) {
  using Sum = Eigen::Matrix<double, 3, 4>;  // the normal equations, right side last
  const auto add = [&](Sum& block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfelResidual& r = residuals[i];
      const Eigen::Vector3d row = basis(surfel, r);
      Eigen::Vector4d with_distance;
      with_distance << row, r.distance;
      block += r.weight / (r.spread * r.spread) * row * with_distance.transpose();
    }
  };
  const Sum sum = sum_over_blocks(residuals.size(), kResidualBlock, Sum(Sum::Zero()), add);
  return sum.leftCols<3>().completeOrthogonalDecomposition().solve(sum.col(3));
}

/// The residuals from the surfel's own plane.
std::vector<SurfelResidual> from_own_plane(const Surfel& surfel, std::span<const std::uint32_t> members,
                                           const BeamsView& beams, const SurfelSettings& settings) {
  std::vector<SurfelResidual> residuals(members.size());
  for_blocks(members.size(), kResidualBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
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
    if (!r.grazes()) r.range_change = -r.distance / r.incidence;
  }
  return residuals;
}

void refine(Surfel& surfel, Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings) {
  const auto members = surfels.beams_of(surfel);
  auto residuals = from_own_plane(surfel, members, beams, settings);
  if (settings.outlier > 0) weigh(residuals, members, beams.views, settings.outlier);
  for (std::size_t k = 0; k < residuals.size(); ++k) surfels.weights[surfel.begin + k] = residuals[k].weight;
  const Eigen::Vector3d plane = fit(surfel, residuals);
  surfel.middle += plane[0] * surfel.normal;
  surfel.normal = (surfel.normal - (plane[1] * surfel.u + plane[2] * surfel.v) / surfel.radius).normalized();
  surfel.v = surfel.normal.cross(surfel.u).normalized();
  surfel.u = surfel.v.cross(surfel.normal);
}

}  // namespace crisp
