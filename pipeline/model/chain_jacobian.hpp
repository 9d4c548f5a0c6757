// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/model/chain.hpp"
#include "pipeline/model/traced_runs.hpp"

namespace crisp::model {

/// A term with respect to some of whose parameters is differentiated.
struct VariedTerm {
  std::shared_ptr<const ModelTerm> term;
  ChainPlace place;                     ///< where it enters the chain
  std::vector<double> values;           ///< of all its parameters
  std::vector<std::size_t> parameters;  ///< those with respect to which is differentiated
  std::vector<std::size_t> columns;     ///< of the Jacobian, one for each of `parameters`
};

/// A parameter of the chain that is seeded from its beginning on: one of few.
struct SeededSlot {
  std::size_t slot = 0;  ///< in LaserChain::slots
  std::size_t column = 0;
};

/// Derivatives of the ends of one laser's beams, by the chain rule: each term is differentiated by itself, in
/// the state that a beam has where the term enters the chain; the rest of the chain then carries the change
/// of that state to the beam's end. So the chain is differentiated with respect to a few quantities of the
/// beam instead of dozens of parameters.
///
/// @tparam kRows  3 for the ends' derivatives, 1 for those along one direction
template <int kRows>
class ChainJacobian {
 public:
  using Directions = Eigen::Matrix<double, kRows, 3>;
  using Derivative = Eigen::Matrix<double, kRows, 1>;

  /// @param chain   has to outlive this
  /// @param values  of the chain's parameters
  /// @param seeded  at most eight
  ChainJacobian(const LaserChain& chain, std::vector<double> values, std::vector<SeededSlot> seeded,
                const std::vector<VariedTerm>& terms);

  /// Traces a run of the laser's beams that starts at `begin`, at most a block. For beams that the plate
  /// covers calls visit(index of the measurement, end of the beam) and then take(index, column,
  /// ∂end/∂parameter).
  ///
  /// @return  the end of the run
  template <class Visit, class Take>
  std::size_t differentiate(const Measurements& beams, std::size_t begin, const PlateTrajectory& plate,
                            const Directions& directions, const Visit& visit, const Take& take) {
    const std::size_t end = run_end(beams, begin, kTracedBlock);
    trace_run(beams, begin, end, plate, directions);
    const std::span<const bool> known(known_.data(), end - begin);
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (!known[i]) continue;
      visit(begin + i, ends_[i].point());
      for (std::size_t k = 0; k < seeded_.size(); ++k) {
        take(begin + i, seeded_[k].column, Derivative(seeded_slopes_[i].col(static_cast<Eigen::Index>(k))));
      }
    }
    for (const Pass& pass : passes_) {
      apply(pass);
      for (std::size_t i = 0; i < known.size(); ++i) {
        if (!known[i]) continue;
        const Moved moved = take_derivatives(pass, i);
        for (std::size_t k = 0; k < pass.columns.size(); ++k)
          take(begin + i, pass.columns[k], Derivative(moved.col(static_cast<Eigen::Index>(k))));
      }
    }
    return end;
  }

 private:
  static constexpr std::size_t kWidth = Jet::DIMENSION;
  static constexpr std::size_t kMostQuantities = 6;
  using Slopes = Eigen::Matrix<double, kRows, kMostQuantities>;
  using Moved = Eigen::Matrix<double, kRows, kWidth>;

  /// A place at which a term enters the chain.
  struct Stop {
    ChainPlace place;
    std::vector<Beam<double>> beams;  ///< as they arrive there
    std::vector<Slopes> slopes;       ///< how the quantities that the term has set then move the ends
  };
  /// A term with some of its parameters seeded in a Jet's derivatives.
  struct Seeded {
    std::shared_ptr<const ModelTerm> term;
    std::vector<Jet> parameters;
  };
  /// Terms of one stop that are differentiated together.
  struct Pass {
    std::size_t stop = 0;
    std::vector<Seeded> terms;
    std::vector<std::size_t> columns;
  };

  std::size_t stop_at(ChainPlace place) const;
  void add_stops(const std::vector<VariedTerm>& terms);
  void add_passes(const VariedTerm& varied);
  void add_groups();
  void trace_run(const Measurements& beams, std::size_t begin, std::size_t end, const PlateTrajectory& plate,
                 const Directions& directions);
  void differentiate_group(const std::vector<std::size_t>& group, const PlateTrajectory& plate,
                           const Directions& directions);
  void differentiate_ends(const Directions& directions);
  void carry_back(const Stop& next, Stop& stop);
  void apply(const Pass& pass);
  Moved take_derivatives(const Pass& pass, std::size_t beam);
  const std::vector<ChainTerm>& terms_of(Phase phase) const {
    return chain_.get().phases[static_cast<std::size_t>(phase)];
  }
  std::vector<Slopes>& end_slopes(Phase phase) { return end_slopes_[static_cast<std::size_t>(phase)]; }

  std::reference_wrapper<const LaserChain> chain_;
  std::vector<double> values_;
  std::vector<SeededSlot> seeded_;
  std::vector<Stop> stops_;   // in the chain's order; of a phase that moves beams without gaps to its end
  std::vector<Pass> passes_;  // by stop
  std::vector<std::vector<std::size_t>> groups_;         // of phases that are differentiated together
  std::array<std::vector<Slopes>, kPhases> end_slopes_;  // of the quantities of each phase, at its end
  std::vector<Beam<double>> readings_, ends_;
  std::array<bool, kTracedBlock> known_{};
  std::vector<Moved> seeded_slopes_;
  std::vector<Beam<Jet>> jets_;
  std::size_t filled_ = 0;  // the stop whose beams jets_ holds
};

extern template class ChainJacobian<1>;
extern template class ChainJacobian<3>;

}  // namespace crisp::model
