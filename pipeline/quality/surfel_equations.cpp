// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_equations.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "pipeline/quality/surfel_sums.hpp"
#include "pipeline/statistics/dense_solvers.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::quality {
namespace {

constexpr std::size_t kBatch = 16384;  // beams of surfels that are summed in a row

/// The pseudo-inverse's effect: X with A X = B, where A is symmetric and may be singular.
Eigen::MatrixXd solve_semidefinite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() == 0) return b;
  constexpr double kNothing = 1e-10;
  const statistics::SymmetricEigen eigen = statistics::eigendecomposition(a);
  const double least = kNothing * eigen.values.cwiseAbs().maxCoeff();
  const Eigen::VectorXd inverse =
      eigen.values.unaryExpr([&](double value) { return value > least ? 1 / value : 0.0; });
  return eigen.vectors * (inverse.asDiagonal() * (eigen.vectors.transpose() * b));
}

/// The same for parameters in metres, radians and seconds: brought to unit diagonal first.
Eigen::MatrixXd solve_in_any_units(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::VectorXd scale =
      a.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  return scale.asDiagonal() *
         solve_semidefinite(scale.asDiagonal() * a * scale.asDiagonal(), scale.asDiagonal() * b);
}

/// Adds the equations of one surfel's beams, after its plane has been projected out.
void add_without_plane(const SurfelSums& sums, std::span<const SurfelResidual> residuals,
                       NormalEquations& to) {
  const Eigen::Index rest = sums.gram.cols() - 3;
  const Eigen::Index m = rest - 1;
  // The plane parameters' response to each parameter. The slope across a wall that is met in one line alone
  // is left open, not determined by rounding.
  const Eigen::MatrixXd share =
      solve_semidefinite(sums.gram.topLeftCorner(3, 3), sums.gram.topRightCorner(3, rest));
  const auto planes = sums.gram.bottomLeftCorner(rest, 3);
  const Eigen::VectorXd vector = sums.gram.col(3).tail(rest) - planes * share.col(0);
  to.chi2 += vector[0];
  to.vector += vector.tail(m);
  to.matrix += sums.gram.bottomRightCorner(m, m);
  to.matrix.noalias() -= planes.bottomRows(m) * share.rightCols(m);
  to.squares += sums.gram.diagonal().tail(m);
  to.range_squares += sums.range_squares;
  to.changed += sums.changed;
  for (std::size_t d = 0; d < sums.block_scores.size(); ++d) {
    const SumsByBlock& scores = sums.block_scores[d];
    const Eigen::MatrixXd left =
        scores.sums.bottomRows(m) - share.rightCols(m).transpose() * scores.sums.topRows<3>();
    for (std::size_t k = 0; k < scores.blocks.size(); ++k) {
      to.block_scores[d].col(scores.blocks[k]) += left.col(static_cast<Eigen::Index>(k));
    }
  }
  std::size_t beams = 0;
  for (const SurfelResidual& r : residuals) {
    if (r.weight == 0) continue;
    ++beams;
    to.weight += r.weight;
    to.influence += std::pow(r.weight * r.distance / r.spread, 2);
    to.stiffness += statistics::biweight_psi_derivative(r.weight);
  }
  to.beams += beams;
  to.degrees_of_freedom += static_cast<double>(beams) - 3;
}

std::vector<std::size_t> counts(std::span<const Division> divisions) {
  std::vector<std::size_t> blocks;
  for (const Division& division : divisions) blocks.push_back(std::ranges::max(division) + std::size_t{1});
  return blocks;
}

/// First surfel of each batch; and one past the last.
std::vector<std::size_t> batches(const Surfels& surfels) {
  std::vector<std::size_t> first{0};
  std::size_t beams = 0;
  for (std::size_t s = 0; s < surfels.surfels.size(); ++s) {
    beams += surfels.surfels[s].end - surfels.surfels[s].begin;
    if (beams < kBatch) continue;
    first.push_back(s + 1);
    beams = 0;
  }
  if (first.back() != surfels.surfels.size()) first.push_back(surfels.surfels.size());
  return first;
}

}  // namespace

NormalEquations::NormalEquations(std::size_t parameters, const std::vector<std::size_t>& blocks) {
  const auto m = static_cast<Eigen::Index>(parameters);
  matrix.setZero(m, m);
  vector.setZero(m);
  squares.setZero(m);
  range_squares.setZero(m);
  changed.setZero(m);
  for (const std::size_t count : blocks) {
    block_scores.emplace_back(Eigen::MatrixXd::Zero(m, static_cast<Eigen::Index>(count)));
  }
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  matrix += other.matrix;
  vector += other.vector;
  chi2 += other.chi2;
  degrees_of_freedom += other.degrees_of_freedom;
  beams += other.beams;
  weight += other.weight;
  influence += other.influence;
  stiffness += other.stiffness;
  squares += other.squares;
  range_squares += other.range_squares;
  changed += other.changed;
  for (std::size_t d = 0; d < block_scores.size(); ++d) block_scores[d] += other.block_scores[d];
  return *this;
}

double NormalEquations::covariance_factor() const {
  const double spent =
      static_cast<double>(beams) / degrees_of_freedom;  // what the planes took of the residuals
  return weight * influence * spent / (stiffness * stiffness);
}

Eigen::MatrixXd NormalEquations::scores_along(std::size_t division, const std::vector<std::size_t>& of,
                                              const Eigen::MatrixXd& directions) const {
  return weight / stiffness * (directions.transpose() * block_scores[division](of, Eigen::all));
}

NormalEquations NormalEquations::reduced(const std::vector<std::size_t>& kept,
                                         const std::vector<std::size_t>& eliminated) const {
  NormalEquations result = *this;
  const Eigen::MatrixXd cross = matrix(eliminated, kept);
  const Eigen::VectorXd gone = vector(eliminated);
  const Eigen::MatrixXd inner = matrix(eliminated, eliminated);
  const Eigen::MatrixXd by_cross = solve_in_any_units(inner, cross);
  result.matrix = matrix(kept, kept) - cross.transpose() * by_cross;
  result.vector = vector(kept) - by_cross.transpose() * gone;
  result.chi2 = chi2 - gone.dot(solve_in_any_units(inner, gone).col(0));
  result.degrees_of_freedom = degrees_of_freedom - static_cast<double>(eliminated.size());
  result.squares = squares(kept);
  result.range_squares = range_squares(kept);
  result.changed = changed(kept);
  for (Eigen::MatrixXd& of_division : result.block_scores) {
    of_division = Eigen::MatrixXd(of_division(kept, Eigen::all)) -
                  by_cross.transpose() * Eigen::MatrixXd(of_division(eliminated, Eigen::all));
  }
  return result;
}

NormalEquations normal_equations(const Surfels& surfels, const BeamsView& beams, std::size_t parameters,
                                 const DerivativeRows& derivatives, const SurfelSettings& settings,
                                 std::span<const Division> divisions) {
  const SurfelSummands summands{
      .parameters = parameters, .derivatives = derivatives, .divisions = divisions, .views = beams.views};
  const auto blocks = counts(divisions);
  const auto first = batches(surfels);
  std::vector<NormalEquations> sums(first.size() - 1, NormalEquations(parameters, blocks));
  for_each_index(sums.size(), [&](std::size_t b) {
    for (std::size_t s = first[b]; s < first[b + 1]; ++s) {
      const Surfel& surfel = surfels.surfels[s];
      const auto residuals = residuals_of(surfel, surfels, beams, settings);
      add_without_plane(sums_of(surfel, surfels.beams_of(surfel), residuals, summands), residuals, sums[b]);
    }
  });
  NormalEquations total(parameters, blocks);
  for (const NormalEquations& sum : sums) total += sum;
  return total;
}

}  // namespace crisp::quality
