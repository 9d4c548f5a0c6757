// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_residuals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pipeline/quality/plane.hpp"

namespace crisp {
namespace {

constexpr double kGrazing = 0.05;  // cosine of the incidence below which a beam runs along the plane

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

Eigen::Vector3d fit(const Surfel& surfel, const std::vector<SurfelResidual>& residuals) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (const SurfelResidual& r : residuals) {
    const Eigen::Vector3d row = basis(surfel, r);
    const double weight = r.weight / (r.spread * r.spread);
    matrix += weight * row * row.transpose();
    vector += weight * r.distance * row;
  }
  return matrix.completeOrthogonalDecomposition().solve(vector);
}

/// What is left of each distance [spreads] after a plane of its view's own: however much views disagree, an
/// outlier is what its own view contradicts.
std::vector<double> within_views(const std::vector<SurfelResidual>& residuals,
                                 const std::vector<std::size_t>& view_of, std::size_t views) {
  std::vector<ViewSums> sums(views);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const SurfelResidual& r = residuals[i];
    if (r.weight > 0) sums[view_of[i]].add(r.u, r.v, r.distance, r.weight / (r.spread * r.spread));
  }
  std::vector<Eigen::Vector3d> planes;
  for (const ViewSums& view : sums) planes.push_back(view.count > 0 ? view.fit() : Eigen::Vector3d::Zero());
  std::vector<double> left;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const SurfelResidual& r = residuals[i];
    left.push_back((r.distance - planes[view_of[i]].dot(Eigen::Vector3d(1, r.u, r.v))) / r.spread);
  }
  return left;
}

double median_size(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Sets the weights by Tukey's biweight; wider where the noise is.
void weigh(double outlier, const std::vector<std::size_t>& view_of, std::size_t views,
           std::vector<SurfelResidual>& residuals) {
  constexpr int kRounds = 3;  // enough for the few per cent of outliers of a room
  for (int round = 0; round < kRounds; ++round) {
    const auto left = within_views(residuals, view_of, views);
    const double end = outlier * std::max(1.0, 1.4826 * median_size(left));
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (std::abs(residuals[i].incidence) < kGrazing) continue;
      const double x = std::min(1.0, std::abs(left[i]) / end);
      residuals[i].weight = (1 - x * x) * (1 - x * x);
    }
  }
}

/// The residuals from the surfel's own plane, weighed.
std::vector<SurfelResidual> weighed(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
                                    const SurfelSettings& settings) {
  std::vector<SurfelResidual> residuals;
  std::vector<std::uint32_t> known;
  std::vector<std::size_t> view_of;
  for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
    const std::uint32_t i = surfels.members[k];
    const Eigen::Vector3d point(beams.points.x[i], beams.points.y[i], beams.points.z[i]);
    const Eigen::Vector3d direction(beams.directions.x[i], beams.directions.y[i], beams.directions.z[i]);
    residuals.push_back(against(surfel, point, direction, settings));
    const std::uint32_t view = beams.views.empty() ? 0 : beams.views[i];
    const auto found = std::ranges::find(known, view);
    view_of.push_back(static_cast<std::size_t>(found - known.begin()));
    if (found == known.end()) known.push_back(view);
  }
  if (settings.outlier > 0) weigh(settings.outlier, view_of, known.size(), residuals);
  return residuals;
}

}  // namespace

std::vector<SurfelResidual> residuals_of(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
                                         const SurfelSettings& settings) {
  auto residuals = weighed(surfel, surfels, beams, settings);
  const Eigen::Vector3d plane = fit(surfel, residuals);
  for (SurfelResidual& r : residuals) {
    r.distance -= plane.dot(basis(surfel, r));
    if (std::abs(r.incidence) >= kGrazing) r.range_change = -r.distance / r.incidence;
  }
  return residuals;
}

Surfel refined(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
               const SurfelSettings& settings) {
  const Eigen::Vector3d plane = fit(surfel, weighed(surfel, surfels, beams, settings));
  Surfel result = surfel;
  result.middle += plane[0] * surfel.normal;
  result.normal = (surfel.normal - (plane[1] * surfel.u + plane[2] * surfel.v) / surfel.radius).normalized();
  result.v = result.normal.cross(surfel.u).normalized();
  result.u = result.v.cross(result.normal);
  return result;
}

}  // namespace crisp
