// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_sums.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/quality/blocks.hpp"

namespace crisp {
namespace {

constexpr std::size_t kBeamsAtOnce = 1024;  // beams whose rows are in memory at once

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double weight_of(const SurfelResidual& r) { return std::sqrt(r.weight) / r.spread; }

Rows weighted_rows(const Surfel& surfel, std::span<const std::uint32_t> members,
                   std::span<const SurfelResidual> residuals, const SurfelSummands& summands) {
  std::vector<double> range_change;
  for (const SurfelResidual& r : residuals) range_change.push_back(r.range_change);
  std::vector<double> rows(members.size() * summands.parameters, 0);
  summands.derivatives(surfel, members, range_change, rows);
  const auto n = static_cast<Eigen::Index>(members.size());
  const auto m = static_cast<Eigen::Index>(summands.parameters);
  Rows all(n, m + 4);
  all.rightCols(m) = Eigen::Map<const Rows>(rows.data(), n, m);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SurfelResidual& r = residuals[static_cast<std::size_t>(i)];
    all.row(i).head<4>() = Eigen::RowVector4d(1, r.u / surfel.radius, r.v / surfel.radius, r.distance);
    all.row(i) *= weight_of(r);
  }
  return all;
}

/// For each beam by what the square of a weighted derivative is to be multiplied to be one of its range.
Eigen::VectorXd per_weight(std::span<const SurfelResidual> residuals) {
  Eigen::VectorXd factors(static_cast<Eigen::Index>(residuals.size()));
  std::ranges::transform(residuals, factors.begin(), [](const SurfelResidual& r) {
    return r.weight > 0 ? 1 / std::pow(weight_of(r) * r.incidence, 2) : 0.0;
  });
  return factors;
}

/// normal · ∂x/∂φ [m] where a beam meets the surfel, of a turn φ about the z axis.
double moved_by_turn(const Surfel& surfel, const SurfelResidual& r) {
  const Eigen::Vector3d foot = surfel.middle + r.u * surfel.u + r.v * surfel.v;
  return surfel.normal.y() * foot.x() - surfel.normal.x() * foot.y();
}

class SurfelSummer {
 public:
  SurfelSummer(const Surfel& surfel, const SurfelSummands& summands)
      : surfel_(surfel), summands_(summands), columns_(static_cast<Eigen::Index>(summands.parameters + 4)) {}

  SurfelSums none(std::span<const std::uint32_t> members) const {
    SurfelSums sums{.gram = Eigen::MatrixXd::Zero(columns_, columns_),
                    .range_squares = Eigen::VectorXd::Zero(columns_ - 4),
                    .changed = Eigen::VectorXd::Zero(columns_ - 4),
                    .pulls = {},
                    .turns = {}};
    for (const std::size_t blocks : summands_.blocks) {
      sums.pulls.emplace_back(Eigen::MatrixXd::Zero(columns_, static_cast<Eigen::Index>(blocks)));
    }
    if (summands_.moment_of.empty() || members.empty()) return sums;
    std::uint32_t first = summands_.moment_of[members[0]];
    std::uint32_t last = first;
    for (const std::uint32_t beam : members) {
      first = std::min(first, summands_.moment_of[beam]);
      last = std::max(last, summands_.moment_of[beam]);
    }
    sums.turns = SumsByMoment(first, last, columns_ + 1);
    return sums;
  }

  void add(std::span<const std::uint32_t> members, std::span<const SurfelResidual> residuals,
           SurfelSums& sums) const {
    const Rows rows = weighted_rows(surfel_, members, residuals, summands_);
    sums.gram.selfadjointView<Eigen::Upper>().rankUpdate(rows.transpose());
    if (!sums.pulls.empty()) add_ranges(rows, residuals, sums);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      for (std::size_t d = 0; d < sums.pulls.size(); ++d) {
        const auto block = static_cast<Eigen::Index>(summands_.divisions[d][members[k]]);
        sums.pulls[d].col(block) += rows(i, 3) * rows.row(i).transpose();
      }
      if (!summands_.moment_of.empty()) {
        const double turn = weight_of(residuals[k]) * moved_by_turn(surfel_, residuals[k]);
        auto sum = sums.turns.of(summands_.moment_of[members[k]]);
        sum.head(columns_) += turn * rows.row(i).transpose();
        sum[columns_] += turn * turn;
      }
    }
  }

 private:
  void add_ranges(const Rows& rows, std::span<const SurfelResidual> residuals, SurfelSums& sums) const {
    const auto derivatives = rows.rightCols(columns_ - 4);
    sums.range_squares += derivatives.cwiseAbs2().transpose() * per_weight(residuals);
    sums.changed += (derivatives.array() != 0).cast<double>().colwise().sum().matrix().transpose();
  }

  const Surfel& surfel_;
  const SurfelSummands& summands_;
  Eigen::Index columns_;
};

}  // namespace

SumsByMoment::SumsByMoment(std::uint32_t first_moment, std::uint32_t last_moment, Eigen::Index rows)
    : first(first_moment), sums(Eigen::MatrixXd::Zero(rows, Eigen::Index{last_moment} - first_moment + 1)) {}

SumsByMoment& SumsByMoment::operator+=(const SumsByMoment& other) {
  sums.middleCols(static_cast<Eigen::Index>(other.first - first), other.sums.cols()) += other.sums;
  return *this;
}

SurfelSums sums_of(const Surfel& surfel, std::span<const std::uint32_t> members,
                   std::span<const SurfelResidual> residuals, const SurfelSummands& summands) {
  constexpr std::size_t kBlock = 8192;  // beams that are summed in a row
  const SurfelSummer summer(surfel, summands);
  std::vector<SurfelSums> parts(blocks_of(members.size(), kBlock));
  for_blocks(members.size(), kBlock, [&](std::size_t part, std::size_t begin, std::size_t end) {
    parts[part] = summer.none(members.subspan(begin, end - begin));
    for (std::size_t k = begin; k < end; k += kBeamsAtOnce) {
      const std::size_t count = std::min(kBeamsAtOnce, end - k);
      summer.add(members.subspan(k, count), residuals.subspan(k, count), parts[part]);
    }
  });
  SurfelSums sum = summer.none(members);
  for (const SurfelSums& part : parts) {
    sum.gram += part.gram;
    sum.range_squares += part.range_squares;
    sum.changed += part.changed;
    for (std::size_t d = 0; d < sum.pulls.size(); ++d) sum.pulls[d] += part.pulls[d];
    if (part.turns.sums.size() > 0) sum.turns += part.turns;
  }
  sum.gram = Eigen::MatrixXd(sum.gram.selfadjointView<Eigen::Upper>());
  return sum;
}

}  // namespace crisp
