// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/residuals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pipeline/estimate/relative_noise.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

/// Orthonormal basis of the plane's column space in a surface's weighted residuals.
Eigen::MatrixX3d span_of_plane(const std::vector<quality::SurfelResidual>& residuals) {
  Eigen::MatrixX3d basis(static_cast<Eigen::Index>(residuals.size()), 3);
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const quality::SurfelResidual& r = residuals[k];
    basis.row(static_cast<Eigen::Index>(k)) =
        Eigen::RowVector3d(1, r.u, r.v) * (std::sqrt(r.weight) / std::max(0.05, std::abs(r.incidence)));
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> qr(basis);
  Eigen::MatrixX3d span = qr.householderQ() * Eigen::MatrixX3d::Identity(basis.rows(), 3);
  span.rightCols(3 - std::min<Eigen::Index>(3, qr.rank())).setZero();
  return span;
}

/// Calls pair(k) where residuals k − 1 and k are consecutive beams of one scan on one surface.
template <class Pair>
void for_each_neighbours(const Residuals& residuals, const Measurements& beams, Pair pair) {
  for (std::size_t s = 0; s + 1 < residuals.first.size(); ++s) {
    for (std::size_t k = residuals.first[s] + 1; k < residuals.first[s + 1]; ++k) {
      if (estimate::are_neighbours(beams, residuals.beam[k - 1], residuals.beam[k])) pair(k);
    }
  }
}

}  // namespace

Residuals residuals_in(const SurfaceObservations& observations, const quality::SurfelSettings& settings) {
  Residuals all;
  for (const quality::Surfel& surfel : observations.surfels().surfels) {
    std::vector<quality::SurfelResidual> counting;
    const auto members = observations.surfels().beams_of(surfel);
    const auto residuals =
        quality::residuals_of(surfel, observations.surfels(), observations.beams(), settings);
    all.first.push_back(all.beam.size());
    for (std::size_t k = 0; k < residuals.size(); ++k) {
      const quality::SurfelResidual& r = residuals[k];
      if (r.weight == 0) continue;
      counting.push_back(r);
      all.beam.push_back(members[k]);
      all.measured.value.push_back(-r.range_change);
      all.measured.weight.push_back(r.weight);
      all.cosine.push_back(std::abs(r.incidence));
      all.reported.push_back(settings.noise * observations.beams().noise_of(members[k]));
      all.end.push_back(settings.outlier * r.spread / std::abs(r.incidence));
    }
    all.planes.push_back(span_of_plane(counting));
  }
  all.first.push_back(all.beam.size());
  return all;
}

std::vector<double> noise_of(const Residuals& residuals, const Measurements& beams) {
  constexpr std::size_t kFewPairs = 1000;
  const std::size_t lasers = beams.laser.empty() ? 0 : std::ranges::max(beams.laser) + std::size_t{1};
  std::vector<std::vector<double>> pairs(lasers);
  std::vector<std::vector<double>> alone(lasers);
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    alone[beams.laser[residuals.beam[k]]].push_back(std::abs(residuals.measured.value[k]) /
                                                    residuals.reported[k]);
  }
  for_each_neighbours(residuals, beams, [&](std::size_t k) {
    pairs[beams.laser[residuals.beam[k]]].push_back(
        std::abs(residuals.measured.value[k] - residuals.measured.value[k - 1]) /
        std::hypot(residuals.reported[k], residuals.reported[k - 1]));
  });
  std::vector<double> noise;
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    auto& sizes = pairs[laser].size() > kFewPairs ? pairs[laser] : alone[laser];
    noise.push_back(sizes.empty() ? 0 : statistics::kMadToSigma * statistics::median_in_place(sizes));
  }
  return noise;
}

double shared_square(const Residuals& residuals, const WeightedResiduals& values, const Measurements& beams) {
  double sum = 0;
  double weights = 0;
  for_each_neighbours(residuals, beams, [&](std::size_t k) {
    const double weight = std::sqrt(values.weight[k] * values.weight[k - 1]);
    sum += weight * values.value[k] * values.value[k - 1];
    weights += weight;
  });
  return weights > 0 ? sum / weights : 0;
}

WeightedResiduals simulated(const Residuals& residuals, const std::vector<double>& noise,
                            std::uint64_t seed) {
  statistics::RandomStream random(seed, "residuals");
  const std::size_t n = residuals.size();
  WeightedResiduals made{.value = std::vector<double>(n), .weight = std::vector<double>(n)};
  for (std::size_t k = 0; k < n; ++k) made.value[k] = noise[k] * residuals.reported[k] * random.normal();
  for (std::size_t s = 0; s < residuals.planes.size(); ++s) {
    const auto members = static_cast<Eigen::Index>(residuals.first[s + 1] - residuals.first[s]);
    if (members == 0) continue;
    const auto first = static_cast<std::ptrdiff_t>(residuals.first[s]);
    Eigen::Map<Eigen::VectorXd> own(made.value.data() + first, members);
    const Eigen::VectorXd roots =
        Eigen::Map<const Eigen::VectorXd>(residuals.measured.weight.data() + first, members).cwiseSqrt();
    const Eigen::VectorXd weighted = roots.cwiseProduct(own);
    own -= (residuals.planes[s] * (residuals.planes[s].transpose() * weighted)).cwiseQuotient(roots);
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double end = residuals.end[k] * std::max(1.0, noise[k]);
    made.weight[k] = statistics::biweight(made.value[k] / end);
  }
  return made;
}

}  // namespace crisp::diagnose
