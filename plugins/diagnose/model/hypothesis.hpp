// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <crisp/findings.hpp>

#include "plugins/diagnose/model/candidates.hpp"
#include "plugins/diagnose/model/score_test.hpp"

namespace crisp::diagnose {

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
  std::vector<Competitor> competitors;     ///< other causes that could explain it, the most likely first
  std::vector<Gain> gains;                 ///< on held-out turns of the plate
  std::vector<AcceptanceTest> tests = {};  ///< each kind once, in the order of acceptance.hpp's rules
  bool accepted = true;                    ///< whether the extended model has it
  std::string rejected = {};               ///< reason of the rejection; empty if accepted or not generalizing

  /// Records a test that decides: a hypothesis that does not pass is rejected.
  ///
  /// @param otherwise  reason of the rejection
  void decide(AcceptanceTest test, const std::string& otherwise) {
    accepted = test.passed;
    rejected = test.passed ? std::string() : otherwise;
    std::erase_if(tests, [&](const AcceptanceTest& earlier) { return earlier.name == test.name; });
    tests.push_back(std::move(test));
  }

  /// [m²] Mean square of the residuals that this hypothesis alone explains.
  ///
  /// @param noise  [m] standard deviation of ranges
  double square(double noise) const { return std::pow(test.visible * noise, 2); }
};

}  // namespace crisp::diagnose
