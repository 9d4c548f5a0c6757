// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "pipeline/statistics/non_negative_regression.hpp"
#include "plugins/diagnose/noise/noise_model.hpp"
#include "plugins/diagnose/noise/normal_mixture.hpp"

namespace crisp::diagnose {

/// Sums over all ranges that the maximization step of EM needs.
struct ExpectationSums {
  explicit ExpectationSums(std::size_t beams);
  void operator+=(const ExpectationSums& other);

  double ranges = 0;
  double log_likelihood = 0;                     ///< [nat]
  double tail = 0;                               ///< expected number of ranges in the tail
  double tail_squares = 0;                       ///< their squares, in units of the deviation
  double separation = 0, separation_weight = 0;  ///< of the least squares that the peaks' separation solves
  statistics::NonNegativeProblem variance{
      model::kVarianceParts};                 ///< squares, as sums of the parts' unit variances
  std::vector<double> far, of_beam, squares;  ///< by beam: in the farther peak, all, squares
};

/// The E-step of EM for a NoiseModel: which component of the mixture each range came from, for blocks of
/// ranges at once. What does not depend on the model is computed once.
class ExpectationStep {
 public:
  /// @param errors  must outlive the object
  explicit ExpectationStep(const RangeErrors& errors);

  /// @param beams  number of beams of the model, at least that of the ranges
  ExpectationSums sums(const NoiseModel& model, std::size_t beams) const;

  /// ln of the density [1/m] of each range, in their order.
  std::vector<double> log_densities(const NoiseModel& model) const;

 private:
  struct Block;

  /// Calls `use` for ranges begin … end − 1, a block at a time.
  void for_each_block(const NoiseModel& model, std::size_t begin, std::size_t end,
                      const std::function<void(const Block&)>& use) const;
  void add(const Block& block, const NoiseModel& model, ExpectationSums& sums) const;

  const RangeErrors& errors_;
  std::array<std::vector<double>, model::kVarianceParts> unit_variances_;  // of each range
};

}  // namespace crisp::diagnose
