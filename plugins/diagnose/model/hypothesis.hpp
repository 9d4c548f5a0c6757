// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <crisp/findings.hpp>

#include "plugins/diagnose/model/candidates.hpp"
#include "plugins/diagnose/model/score_test.hpp"

namespace crisp {

/// Hypothesis that the sensor has one candidate term, with its tests and its state.
struct Hypothesis {
  Candidate candidate;  ///< with its estimates
  ScoreTest test;
  struct Competitor {
    std::string name;
    double behind = 0;  ///< BIC of the hypothesis less the competitor's
    std::string term = {};
    std::size_t owner = 0;
  };
  std::vector<Competitor> competitors;  ///< other causes that could explain it, the most likely first
  std::vector<Gain> gains;              ///< on held-out turns of the plate
  bool accepted = true;                 ///< whether the extended model has it
  double unexplained = 0;               ///< [m²] mean square of the systematic residual that remains
  bool is_clock_line = false;  ///< whether it corrects an error of the laser's clock line, and is no cause
  std::string rejected = {};   ///< reason of the rejection; empty if accepted or not generalizing

  /// Rejects the hypothesis, whatever its gains.
  void reject(std::string why) {
    accepted = false;
    rejected = std::move(why);
  }

  /// [m²] Mean square of the residuals that this hypothesis alone explains.
  ///
  /// @param noise  [m] standard deviation of ranges
  double square(double noise) const { return std::pow(test.visible * noise, 2); }
};

}  // namespace crisp
