// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_residuals.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/plane.hpp"
#include "pipeline/quality/surfel_weights.hpp"
#include "pipeline/quality/vector_at.hpp"

namespace crisp::quality {
namespace {

/// @param noise  [m] of the range
SurfelResidual against(const Surfel& surfel, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                       double noise, double floor) {
  SurfelResidual r;
  const Eigen::Vector3d offset = point - surfel.middle;
  r.incidence = surfel.normal.dot(direction);
  r.distance = surfel.normal.dot(offset);
  const double across = noise * r.incidence;
  r.spread = std::sqrt(across * across + floor * floor);
  if (!r.grazes()) {
    r.weight = 1;
    r.range_change = -r.distance / r.incidence;
  }
  const Eigen::Vector3d foot = offset + r.range_change * direction;
  r.u = surfel.u.dot(foot);
  r.v = surfel.v.dot(foot);
  return r;
}

/// The plane that fits the residuals best: its distance [m] at the surfel's middle, and its slopes along u
/// and v.
Eigen::Vector3d fit(const Surfel& surfel, const std::vector<SurfelResidual>& residuals) {
  const auto add = [&](ViewSums& block, std::size_t begin, std::size_t end) {
    ViewSums sums;
    for (std::size_t i = begin; i < end; ++i) {
      const SurfelResidual& r = residuals[i];
      sums.add(r.u, r.v, r.distance, r.weight / (r.spread * r.spread));
    }
    block = sums;
  };
  const ViewSums sums = sum_over_blocks(residuals.size(), kResidualBlock, ViewSums(), add);
  // As much is made of a slope as of what it moves the surfel's beams by.
  const Eigen::Vector3d scale(1, 1 / surfel.radius, 1 / surfel.radius);
  const Eigen::Matrix3d matrix = scale.asDiagonal() * sums.matrix() * scale.asDiagonal();
  const Eigen::Vector3d vector = scale.cwiseProduct(sums.vector());
  return scale.cwiseProduct(matrix.completeOrthogonalDecomposition().solve(vector));
}

/// The residuals from the surfel's own plane.
std::vector<SurfelResidual> from_own_plane(const Surfel& surfel, std::span<const std::uint32_t> members,
                                           const BeamsView& beams, const SurfelSettings& settings) {
  std::vector<SurfelResidual> residuals(members.size());
  for_blocks(members.size(), kResidualBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = members[k];
      const Eigen::Vector3d point = vector_at(beams.points, i);
      const Eigen::Vector3d direction = vector_at(beams.directions, i);
      residuals[k] = against(surfel, point, direction, settings.noise * beams.noise_of(i), settings.floor);
    }
  });
  return residuals;
}

/// The same, with the weights that the beams have.
std::vector<SurfelResidual> weighted_from_own_plane(const Surfel& surfel, const Surfels& surfels,
                                                    const BeamsView& beams, const SurfelSettings& settings) {
  auto residuals = from_own_plane(surfel, surfels.beams_of(surfel), beams, settings);
  for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k].weight = surfels.weights[surfel.begin + k];
  return residuals;
}

/// @param plane  see fit()
void move(Surfel& surfel, const Eigen::Vector3d& plane) {
  surfel.middle += plane[0] * surfel.normal;
  surfel.normal = (surfel.normal - plane[1] * surfel.u - plane[2] * surfel.v).normalized();
  surfel.v = surfel.normal.cross(surfel.u).normalized();
  surfel.u = surfel.v.cross(surfel.normal);
}

/// Mean |cosine| between the beams and the normal.
double mean_incidence(const std::vector<SurfelResidual>& residuals) {
  double sum = 0;
  for (const SurfelResidual& r : residuals) sum += std::abs(r.incidence);
  return sum / static_cast<double>(std::max<std::size_t>(1, residuals.size()));
}

void refit(Surfel& surfel, const Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings) {
  constexpr int kRounds = 3;           // where a beam meets the plane depends on the plane
  constexpr double kSmallTurn = 1e-3;  // [rad] small against the angle at which beams still count
  constexpr double kSteep = 0.8;       // met so steeply, a plane's turns of some degrees matter little
  for (int round = 0; round < kRounds; ++round) {
    const auto residuals = weighted_from_own_plane(surfel, surfels, beams, settings);
    if (mean_incidence(residuals) > kSteep) return;
    const Eigen::Vector3d plane = fit(surfel, residuals);
    move(surfel, plane);
    if (plane.tail<2>().norm() < kSmallTurn) return;
  }
}

}  // namespace

std::vector<SurfelResidual> residuals_of(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
                                         const SurfelSettings& settings) {
  auto residuals = weighted_from_own_plane(surfel, surfels, beams, settings);
  const Eigen::Vector3d plane = fit(surfel, residuals);
  for (SurfelResidual& r : residuals) {
    r.distance -= plane.dot(Eigen::Vector3d(1, r.u, r.v));
    if (!r.grazes()) r.range_change = -r.distance / r.incidence;
  }
  return residuals;
}

void refit_all(Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings) {
  for_each_index(surfels.surfels.size(),
                 [&](std::size_t s) { refit(surfels.surfels[s], surfels, beams, settings); });
}

void refine(Surfel& surfel, Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings) {
  const auto members = surfels.beams_of(surfel);
  auto residuals = from_own_plane(surfel, members, beams, settings);
  if (settings.outlier > 0) weigh(residuals, members, beams.views, settings.outlier);
  for (std::size_t k = 0; k < residuals.size(); ++k) surfels.weights[surfel.begin + k] = residuals[k].weight;
  move(surfel, fit(surfel, residuals));
}

void refine_all(Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings) {
  for_each_index(surfels.surfels.size(),
                 [&](std::size_t s) { refine(surfels.surfels[s], surfels, beams, settings); });
}

}  // namespace crisp::quality
