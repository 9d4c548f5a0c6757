// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/shared_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "pipeline/quality/vector_at.hpp"
#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::estimate {
namespace {

using quality::Division;

constexpr std::uint32_t kMin = 100;  // blocks, to see by how much their block_scores scatter

/// The number of beams in a scan of each laser, from the beams at hand.
std::vector<std::uint32_t> beams_of_scans(const Measurements& beams) {
  std::vector<std::uint32_t> most;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] >= most.size()) most.resize(beams.laser[i] + std::size_t{1}, 0);
    most[beams.laser[i]] = std::max<std::uint32_t>(most[beams.laser[i]], beams.beam[i] + 1U);
  }
  return most;
}

constexpr std::uint32_t kPlaces = 4;  // along each side of a surface
static_assert(kPlaces * kPlaces == kPlacesOfEach);

/// Intersection of a beam with a surface's plane, independent of the point's noise: otherwise beams would be
/// sorted by their noise.
Eigen::Vector2d foot_on(const quality::Surfel& surfel, const quality::BeamsView& beams, std::uint32_t i) {
  const Eigen::Vector3d point = quality::vector_at(beams.points, i);
  const Eigen::Vector3d direction = quality::vector_at(beams.directions, i);
  const double incidence = surfel.normal.dot(direction);
  const Eigen::Vector3d from_middle = point - surfel.middle;
  const double further = incidence < 0 ? -surfel.normal.dot(from_middle) / incidence : 0;
  const Eigen::Vector3d foot = from_middle + further * direction;
  return {surfel.u.dot(foot), surfel.v.dot(foot)};
}

}  // namespace

std::uint32_t place_on(const quality::Surfel& surfel, const Eigen::Vector2d& foot) {
  const auto step = [&](double along) {  // the sides of a square are 1.2 times its radius away
    const double share = std::clamp(along / (2 * surfel.radius) + 0.5, 0.0, 1.0);
    return std::min(kPlaces - 1, static_cast<std::uint32_t>(share * kPlaces));
  };
  return kPlaces * step(foot.x()) + step(foot.y());
}

Division recording_blocks(const Measurements& beams) {
  constexpr double kLong = 0.1;  // [s]
  const auto [first, last] = std::ranges::minmax(beams.time);
  const double length = std::max(1e-9, std::min(kLong, (last - first) / kMin));
  const auto piece = [&, first = first](double time) {
    return static_cast<std::int64_t>((time - first) / length);
  };
  std::map<std::int64_t, std::uint32_t> numbers;  // without the pieces of pauses
  for (const double time : beams.time) numbers.try_emplace(numbers.end(), piece(time), 0);
  std::uint32_t next = 0;
  for (auto& [at, number] : numbers) number = next++;
  Division blocks;
  blocks.reserve(beams.size());
  auto at = numbers.begin();
  for (const double time : beams.time) {
    if (at->first != piece(time)) at = numbers.find(piece(time));
    blocks.push_back(at->second);
  }
  return blocks;
}

Division quantization_blocks(const Sample& sample, double step) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  Division blocks = recording_blocks(sample.beams);
  std::vector<double> begins;  // [s] of the blocks
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i] >= begins.size()) begins.resize(blocks[i] + std::size_t{1}, kNever);
    begins[blocks[i]] = std::min(begins[blocks[i]], sample.beams.time[i]);
  }
  std::vector<std::uint32_t> merged;
  std::optional<PlateState> first;  // of the merged block
  for (const double begin : begins) {
    const auto state = sample.plate->at(begin);
    const bool stands = first && state && std::abs(state->angle - first->angle) < step;
    if (!stands) first = state;
    merged.push_back(merged.empty() ? 0 : merged.back() + (stands ? 0 : 1));
  }
  for (std::uint32_t& block : blocks) block = merged[block];
  return blocks;
}

Division scan_blocks(const Measurements& beams) {
  const auto of_scan = beams_of_scans(beams);
  Division blocks = recording_blocks(beams);
  const bool has_pieces = std::ranges::any_of(of_scan, [](std::uint32_t n) { return n > 0 && n < kMin; });
  const std::uint32_t first = has_pieces ? std::ranges::max(blocks) + 1 : 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::uint32_t laser = beams.laser[i];
    if (of_scan[laser] < kMin) continue;
    blocks[i] = first + kMin * laser + kMin * beams.beam[i] / of_scan[laser];
  }
  return blocks;
}

Division place_blocks(const quality::Surfels& surfels, const quality::BeamsView& beams) {
  Division blocks(beams.points.size(), 0);
  for (std::size_t s = 0; s < surfels.surfels.size(); ++s) {
    const quality::Surfel& surfel = surfels.surfels[s];
    for (const std::uint32_t i : surfels.beams_of(surfel)) {
      blocks[i] = static_cast<std::uint32_t>(
          (kPlacesOfEach * s + place_on(surfel, foot_on(surfel, beams, i))) % kMin);
    }
  }
  return blocks;
}

Eigen::VectorXd widening(const quality::NormalEquations& equations) {
  constexpr double kSure = 2;  // [standard errors of a logarithm]
  const Eigen::Index m = equations.matrix.cols();
  std::vector<std::size_t> all(static_cast<std::size_t>(m));
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Eigen::MatrixXd inverse =
      statistics::solve_positive_definite(equations.matrix, Eigen::MatrixXd(Eigen::MatrixXd::Identity(m, m)));
  const Eigen::ArrayXd alone = inverse.diagonal() * equations.covariance_factor();
  Eigen::ArrayXd wider = Eigen::ArrayXd::Ones(m);
  for (std::size_t division = 0; division < equations.block_scores.size(); ++division) {
    const Eigen::ArrayXXd squares = equations.scores_along(division, all, inverse).array().square();
    const auto count = static_cast<double>(squares.cols());
    const auto spent = static_cast<double>(m);
    if (count <= 2 * spent) continue;
    const double unbiased = count / (count - spent);
    const Eigen::ArrayXd sum = squares.rowwise().sum() * unbiased;
    const Eigen::ArrayXd error =
        (squares.square().rowwise().sum() * unbiased * unbiased - sum.square() / count).sqrt();
    const Eigen::ArrayXd least = sum * (-kSure * error / sum).exp();
    wider = (least > alone).select(wider.max(sum / alone), wider);
  }
  return wider.sqrt();
}

Eigen::VectorXd widening_with_prior(const Eigen::VectorXd& by, const Eigen::VectorXd& of_prior) {
  const Eigen::ArrayXd prior = of_prior.array().max(0).min(1);
  return ((1 - prior) / by.array().square() + prior).rsqrt();
}

Eigen::MatrixXd widened(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& by) {
  const Eigen::VectorXd excess = (by.array().square() - 1).sqrt();
  return covariance + excess.asDiagonal() * covariance * excess.asDiagonal();
}

std::vector<Division> shared_errors(const Sample& sample, const quality::Surfels& surfels,
                                    const quality::BeamsView& placed, double step) {
  return {quantization_blocks(sample, step), scan_blocks(sample.beams), place_blocks(surfels, placed)};
}

}  // namespace crisp::estimate
