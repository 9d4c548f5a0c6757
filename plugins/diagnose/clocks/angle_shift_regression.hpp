// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "plugins/diagnose/clocks/angle_shifts.hpp"

namespace crisp::diagnose {

/// Robust linear model of n angle shifts, fitted by iteratively reweighted least squares (Huber's weights).
/// Its nuisance terms are a lag per laser times the change of rate, the square of the rate, and its sign
/// (backlash). The others are steps of the encoder's zero at given times.
class AngleShiftModel {
 public:
  /// @param shifts  must outlive this object
  /// @param times   [s since epoch] of the steps
  AngleShiftModel(std::span<const AngleShift> shifts, std::vector<double> times);

  /// Adds or removes a step, and refits the model.
  void add(double time);
  void remove(std::size_t step);

  std::size_t steps() const { return times_.size(); }
  double size(std::size_t step) const;  ///< [rad]
  /// [rad] Sandwich standard error, clustered by blocks of 0.1 s (Liang and Zeger 1986); infinite where two
  /// steps lie across the same shifts.
  double std_error(std::size_t step) const;
  const Eigen::VectorXd& residuals() const { return residuals_; }  ///< [rad] n

  /// Score test of one more step.
  struct StepScore {
    std::int64_t block = 0;  ///< at whose beginning
    double gain = 0;         ///< [rad²] decrease of the weighted squares, the other parameters refitted
    double shifts = 0;       ///< weights of those across it
  };
  /// At the beginning of each block across which there are shifts, by time. A lag times a change of rate
  /// resembles a step where the plate accelerates: what the other parameters absorb is taken into account.
  std::vector<StepScore> step_scores() const;

  /// [s] Duration of the blocks that count as independent.
  static constexpr double kBlock = 0.1;
  static std::int64_t block_of(double time);

 private:
  Eigen::Index column(std::size_t step) const { return static_cast<Eigen::Index>(nuisances_ + step); }
  Eigen::VectorXd row(const AngleShift& shift) const;
  void fit();
  Eigen::MatrixXd clustered_scores(const Eigen::MatrixXd& rows) const;
  double scale() const;

  std::span<const AngleShift> shifts_;
  std::size_t nuisances_ = 0;
  std::vector<double> times_;
  Eigen::VectorXd solution_;
  Eigen::VectorXd residuals_;
  Eigen::VectorXd weights_;  // n, up to 1
  Eigen::MatrixXd inverse_;  // of the normal equations' matrix
  Eigen::MatrixXd covariance_;
};

/// Whether a step at `time` [s since epoch] lies between the two passes of a shift.
inline bool is_across(const AngleShift& shift, double time) {
  return shift.earlier < time && time <= shift.later;
}

}  // namespace crisp::diagnose
