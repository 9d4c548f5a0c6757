// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/encoder_nuisance.hpp"

#include <Eigen/Cholesky>
#include <vector>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_sums.hpp"

namespace crisp::quality {
namespace {

/// The normal matrix of the planes (three unknowns each), the turns and the parameters.
class Together {
 public:
  Together(std::size_t surfels, std::size_t parameters, std::span<const double> variances)
      : parameters_(static_cast<Eigen::Index>(parameters)) {
    const auto unknown = 3 * static_cast<Eigen::Index>(surfels);
    const auto moments = static_cast<Eigen::Index>(variances.size());
    planes_.setZero(unknown, unknown);
    mixed_.setZero(unknown, parameters_);
    own_.setZero(parameters_, parameters_);
    plane_turns_.setZero(unknown, moments);
    own_turns_.setZero(parameters_, moments);
    turns_ = Eigen::Map<const Eigen::VectorXd>(variances.data(), moments).cwiseInverse();
  }

  void add(std::size_t surfel, const SurfelSums& sums) {
    // The slope across a wall that is met in one line alone stays, as does a plane none of whose beams
    // counts.
    constexpr double kNothing = 1e-10;
    const auto at = 3 * static_cast<Eigen::Index>(surfel);
    const Eigen::Matrix3d plane = sums.gram.topLeftCorner<3, 3>();
    planes_.block<3, 3>(at, at) = plane + kNothing * (1 + plane.trace()) * Eigen::Matrix3d::Identity();
    mixed_.middleRows<3>(at) = sums.gram.topRightCorner(3, parameters_);
    own_ += sums.gram.bottomRightCorner(parameters_, parameters_);
    const auto first = static_cast<Eigen::Index>(sums.turns.first);
    const Eigen::Index moments = sums.turns.sums.cols();
    plane_turns_.block(at, first, 3, moments) = sums.turns.sums.topRows<3>();
    own_turns_.middleCols(first, moments) += sums.turns.sums.middleRows(4, parameters_);
    turns_.segment(first, moments) += sums.turns.sums.bottomRows<1>().transpose();
  }

  Eigen::MatrixXd information() const {
    const Eigen::VectorXd root = turns_.cwiseInverse().cwiseSqrt();
    const Eigen::MatrixXd by_turns = own_turns_ * root.asDiagonal();
    const Eigen::MatrixXd planes_by_turns = plane_turns_ * root.asDiagonal();
    Eigen::MatrixXd planes = planes_;
    planes.selfadjointView<Eigen::Lower>().rankUpdate(planes_by_turns, -1);
    const Eigen::MatrixXd mixed = mixed_ - planes_by_turns * by_turns.transpose();
    const Eigen::MatrixXd left =
        own_ - by_turns * by_turns.transpose() -
        mixed.transpose() * planes.selfadjointView<Eigen::Lower>().llt().solve(mixed);
    return left.selfadjointView<Eigen::Lower>();  // to the last bit
  }

 private:
  Eigen::Index parameters_;
  Eigen::MatrixXd planes_;       // planes by planes
  Eigen::MatrixXd mixed_;        // planes by parameters
  Eigen::MatrixXd own_;          // parameters by parameters
  Eigen::MatrixXd plane_turns_;  // planes by turns
  Eigen::MatrixXd own_turns_;    // parameters by turns
  Eigen::VectorXd turns_;        // turns by turns: with what is known of each beforehand
};

}  // namespace

Eigen::MatrixXd information_with_turns(const Surfels& surfels, const BeamsView& beams, std::size_t parameters,
                                       const DerivativeRows& derivatives, const SurfelSettings& settings,
                                       const SharedTurns& turns) {
  const SurfelSummands summands{
      .parameters = parameters, .derivatives = derivatives, .moment_of = turns.moments};
  std::vector<SurfelSums> sums(surfels.surfels.size());
  for_each_index(sums.size(), [&](std::size_t s) {
    const Surfel& surfel = surfels.surfels[s];
    sums[s] =
        sums_of(surfel, surfels.beams_of(surfel), residuals_of(surfel, surfels, beams, settings), summands);
  });
  Together all(sums.size(), parameters, turns.variances);
  for (std::size_t s = 0; s < sums.size(); ++s) all.add(s, sums[s]);
  return all.information();
}

}  // namespace crisp::quality
