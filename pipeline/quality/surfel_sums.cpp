// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_sums.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "pipeline/quality/blocks.hpp"

namespace crisp::quality {
namespace {

constexpr std::size_t kBeamsAtOnce = 1024;  // beams whose rows are in memory at once
constexpr Eigen::Index kOwn = 4;            // columns of the surfel itself: its plane and the distance

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
  Rows all(n, m + kOwn);
  all.rightCols(m) = Eigen::Map<const Rows>(rows.data(), n, m);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SurfelResidual& r = residuals[static_cast<std::size_t>(i)];
    all.row(i).head<kOwn>() = Eigen::RowVector4d(1, r.u / surfel.radius, r.v / surfel.radius, r.distance);
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

/// Rows of some beams, without the columns that are zero for all of them: most parameters are of one laser.
struct CompactRows {
  Rows rows;
  std::vector<Eigen::Index> columns;  // of all
};

CompactRows without_zeros(Rows rows) {
  CompactRows compact;
  const Eigen::RowVectorXd largest = rows.cwiseAbs().colwise().maxCoeff();
  for (Eigen::Index column = 0; column < rows.cols(); ++column) {
    if (column < kOwn || largest[column] > 0) compact.columns.push_back(column);
  }
  const bool is_full = static_cast<Eigen::Index>(compact.columns.size()) == rows.cols();
  compact.rows = is_full ? std::move(rows) : Rows(rows(Eigen::all, compact.columns));
  return compact;
}

/// Some beams of a surfel.
struct SomeBeams {
  std::vector<std::uint32_t> members;
  std::vector<SurfelResidual> residuals;
};

/// The beams by laser, in their order: a laser's derivatives by the parameters of another are zero.
std::map<std::uint32_t, SomeBeams> by_laser(std::span<const std::uint32_t> members,
                                            std::span<const SurfelResidual> residuals,
                                            std::span<const std::uint32_t> views) {
  std::map<std::uint32_t, SomeBeams> lasers;
  for (std::size_t k = 0; k < members.size(); ++k) {
    SomeBeams& own = lasers[views[members[k]] / 2];
    own.members.push_back(members[k]);
    own.residuals.push_back(residuals[k]);
  }
  return lasers;
}

class SurfelSummer {
 public:
  SurfelSummer(const Surfel& surfel, std::span<const std::uint32_t> members, const SurfelSummands& summands)
      : surfel_(surfel),
        summands_(summands),
        columns_(static_cast<Eigen::Index>(summands.parameters) + kOwn) {
    for (const Division& division : summands.divisions) {
      std::vector<std::uint32_t>& blocks = blocks_.emplace_back();
      for (const std::uint32_t beam : members) blocks.push_back(division[beam]);
      std::sort(blocks.begin(), blocks.end());
      blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
      std::vector<Eigen::Index>& places = places_.emplace_back(blocks.empty() ? 0 : blocks.back() + 1);
      for (std::size_t k = 0; k < blocks.size(); ++k) places[blocks[k]] = static_cast<Eigen::Index>(k);
    }
  }

  SurfelSums none(std::span<const std::uint32_t> members) const {
    SurfelSums sums{.gram = Eigen::MatrixXd::Zero(columns_, columns_),
                    .range_squares = Eigen::VectorXd::Zero(columns_ - kOwn),
                    .changed = Eigen::VectorXd::Zero(columns_ - kOwn),
                    .block_scores = {},
                    .turns = {}};
    for (const auto& blocks : blocks_) {
      const auto count = static_cast<Eigen::Index>(blocks.size());
      sums.block_scores.push_back({.blocks = blocks, .sums = Eigen::MatrixXd::Zero(columns_, count)});
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
    constexpr std::size_t kMany = 32;  // parameters from which it pays to leave out those of other lasers
    if (summands_.views.empty() || summands_.parameters < kMany) {
      add_rows({weighted_rows(surfel_, members, residuals, summands_), all_columns()}, members, residuals,
               sums);
      return;
    }
    for (const auto& [laser, own] : by_laser(members, residuals, summands_.views)) {
      add_rows(without_zeros(weighted_rows(surfel_, own.members, own.residuals, summands_)), own.members,
               own.residuals, sums);
    }
  }

 private:
  std::vector<Eigen::Index> all_columns() const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(columns_));
    std::iota(columns.begin(), columns.end(), Eigen::Index{0});
    return columns;
  }

  void add_rows(const CompactRows& some, std::span<const std::uint32_t> members,
                std::span<const SurfelResidual> residuals, SurfelSums& sums) const {
    add_gram(some, sums.gram);
    if (!sums.block_scores.empty()) add_ranges(some, residuals, sums);
    for (std::size_t d = 0; d < sums.block_scores.size(); ++d) {
      for (std::size_t k = 0; k < members.size(); ++k) {
        const auto row = some.rows.row(static_cast<Eigen::Index>(k));
        auto score = sums.block_scores[d].sums.col(places_[d][summands_.divisions[d][members[k]]]);
        for (std::size_t c = 0; c < some.columns.size(); ++c) {
          score[some.columns[c]] += row[3] * row[static_cast<Eigen::Index>(c)];
        }
      }
    }
    if (!summands_.moment_of.empty()) add_turns(some, members, residuals, sums.turns);
  }

  /// Its upper half.
  static void add_gram(const CompactRows& some, Eigen::MatrixXd& gram) {
    if (some.rows.cols() == gram.cols()) {
      gram.selfadjointView<Eigen::Upper>().rankUpdate(some.rows.transpose());
      return;
    }
    Eigen::MatrixXd compact = Eigen::MatrixXd::Zero(some.rows.cols(), some.rows.cols());
    compact.selfadjointView<Eigen::Upper>().rankUpdate(some.rows.transpose());
    for (Eigen::Index column = 0; column < compact.cols(); ++column) {
      auto to = gram.col(some.columns[static_cast<std::size_t>(column)]);
      for (Eigen::Index row = 0; row <= column; ++row) {
        to[some.columns[static_cast<std::size_t>(row)]] += compact(row, column);
      }
    }
  }

  static void add_ranges(const CompactRows& some, std::span<const SurfelResidual> residuals,
                         SurfelSums& sums) {
    const auto derivatives = some.rows.rightCols(some.rows.cols() - kOwn);
    const Eigen::VectorXd squares = derivatives.cwiseAbs2().transpose() * per_weight(residuals);
    const Eigen::VectorXd changed =
        (derivatives.array() != 0).cast<double>().colwise().sum().matrix().transpose();
    for (Eigen::Index k = 0; k < squares.size(); ++k) {
      const Eigen::Index parameter = some.columns[static_cast<std::size_t>(k + kOwn)] - kOwn;
      sums.range_squares[parameter] += squares[k];
      sums.changed[parameter] += changed[k];
    }
  }

  void add_turns(const CompactRows& some, std::span<const std::uint32_t> members,
                 std::span<const SurfelResidual> residuals, SumsByMoment& turns) const {
    for (std::size_t k = 0; k < members.size(); ++k) {
      const double turn = weight_of(residuals[k]) * moved_by_turn(surfel_, residuals[k]);
      auto sum = turns.of(summands_.moment_of[members[k]]);
      const auto row = some.rows.row(static_cast<Eigen::Index>(k));
      for (std::size_t c = 0; c < some.columns.size(); ++c) {
        sum[some.columns[c]] += turn * row[static_cast<Eigen::Index>(c)];
      }
      sum[columns_] += turn * turn;
    }
  }

  const Surfel& surfel_;
  const SurfelSummands& summands_;
  Eigen::Index columns_;
  std::vector<std::vector<std::uint32_t>> blocks_;  // of each division those that the beams are of
  std::vector<std::vector<Eigen::Index>> places_;   // of each division, by block, its place among these
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
  const SurfelSummer summer(surfel, members, summands);
  std::vector<SurfelSums> parts(blocks_of(members.size(), kBlock));
  for_blocks(members.size(), kBlock, [&](std::size_t part, std::size_t begin, std::size_t end) {
    parts[part] = summer.none(members.subspan(begin, end - begin));
    for (std::size_t k = begin; k < end; k += kBeamsAtOnce) {
      const std::size_t count = std::min(kBeamsAtOnce, end - k);
      summer.add(members.subspan(k, count), residuals.subspan(k, count), parts[part]);
    }
  });
  SurfelSums sum = parts.size() == 1 ? std::move(parts.front()) : summer.none(members);
  for (const SurfelSums& part : std::span(parts).subspan(parts.size() == 1 ? 1 : 0)) {
    sum.gram += part.gram;
    sum.range_squares += part.range_squares;
    sum.changed += part.changed;
    for (std::size_t d = 0; d < sum.block_scores.size(); ++d) {
      sum.block_scores[d].sums += part.block_scores[d].sums;
    }
    if (part.turns.sums.size() > 0) sum.turns += part.turns;
  }
  sum.gram = Eigen::MatrixXd(sum.gram.selfadjointView<Eigen::Upper>());
  return sum;
}

}  // namespace crisp::quality
