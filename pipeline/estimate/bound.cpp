// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/bound.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

#include "pipeline/data/internal_error.hpp"
#include "pipeline/estimate/encoder_error_blocks.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/surfel_jacobian.hpp"
#include "pipeline/quality/surfel_equations.hpp"
#include "pipeline/quality/vector_at.hpp"
#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::estimate {
namespace {

/// Each true plane as a surfel of all the beams that meet it.
quality::Surfels surfels_of_truth(const quality::BeamsView& beams, std::span<const std::uint32_t> surface,
                                  std::span<const Eigen::Vector3d> normals) {
  std::vector<std::vector<std::uint32_t>> members(normals.size());
  for (std::uint32_t i = 0; i < surface.size(); ++i) {
    if (surface[i] >= normals.size())
      throw data::internal_error(fmt::format("a beam meets surface {} of {}", surface[i], normals.size()));
    members[surface[i]].push_back(i);
  }
  quality::Surfels result;
  for (std::size_t s = 0; s < normals.size(); ++s) {
    if (members[s].empty()) continue;
    quality::Surfel surfel{.middle = Eigen::Vector3d::Zero(), .normal = normals[s]};
    for (const auto i : members[s]) surfel.middle += quality::vector_at(beams.points, i);
    surfel.middle /= static_cast<double>(members[s].size());
    double squares = 0;
    for (const auto i : members[s])
      squares += (quality::vector_at(beams.points, i) - surfel.middle).squaredNorm();
    constexpr double kSmallest = 1e-3;  // [m] a plane that one beam meets must not divide by nothing
    surfel.radius = std::max(kSmallest, std::sqrt(squares / static_cast<double>(members[s].size())));
    surfel.u = surfel.normal.unitOrthogonal();
    surfel.v = surfel.normal.cross(surfel.u);
    result.add(surfel, members[s]);
  }
  return result;
}

}  // namespace

Eigen::MatrixXd calibration_information(const SensorModel& truth, const Sample& beams,
                                        std::span<const std::uint32_t> surface,
                                        std::span<const Eigen::Vector3d> normals,
                                        const std::vector<std::size_t>& free, const BoundNoise& noise) {
  if (surface.size() != beams.beams.size())
    throw data::internal_error(fmt::format("{} beams have {} surfaces", beams.beams.size(), surface.size()));
  if (!(noise.range > 0))
    throw Error("the ranges have no noise, so that there is no bound", "give a sigma above 0 m");
  const PlacedBeams placed(truth, beams);
  const quality::Surfels surfels = surfels_of_truth(placed.view(), surface, normals);
  const quality::DerivativeRows rows = surfel_rows(truth, beams, free);
  const quality::SurfelSettings exact{.noise = noise.range, .floor = 1e-6 * noise.range};
  if (noise.encoder_step <= 0) {
    return quality::normal_equations(surfels, placed.view(), free.size(), rows, exact).matrix;
  }
  const EncoderErrorBlocks moments = encoder_error_blocks(truth, beams, noise.encoder_step);
  return quality::information_with_turns(surfels, placed.view(), free.size(), rows, exact, moments.turns());
}

Eigen::VectorXd least_std_errors(const Eigen::MatrixXd& information) {
  if (information.size() == 0) return {};
  // To unit diagonal first: parameters come in metres, radians and seconds.
  const Eigen::VectorXd scale =
      information.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 1.0; });
  const statistics::SymmetricEigen eigen =
      statistics::eigendecomposition(scale.asDiagonal() * information * scale.asDiagonal());
  constexpr double kNothing = 1e-10;  // of what a parameter alone would be known by
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(scale.size());
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    const double known = eigen.values[k];
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
      const double share = std::pow(eigen.vectors(i, k), 2);
      if (known > kNothing) {
        variance[i] += share / known;
      } else if (share > kNothing) {
        variance[i] = std::numeric_limits<double>::infinity();
      }
    }
  }
  return scale.cwiseProduct(variance.cwiseSqrt());
}

}  // namespace crisp::estimate
