// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/clock_lines.hpp"

#include <cmath>

#include "plugins/diagnose/model/significance.hpp"

namespace crisp::diagnose {
namespace {

constexpr const char* kDrift = "clock.drift";  // its parameters are the skew at the epoch and its growth
constexpr double kLineErrors = 3;              // [standard errors]

struct Drift {
  Parameter skew;
  Parameter growth;  ///< [1/s]
};

Parameter estimated(const estimate::Outcome& outcome, Eigen::Index at) {
  const auto parameter = outcome.free[static_cast<std::size_t>(at)];
  return {.name = outcome.model.names()[parameter],
          .unit = "1",
          .value = outcome.model.values()[static_cast<Eigen::Index>(parameter)],
          .std_error = std::sqrt(outcome.covariance(at, at))};
}

/// Empty for other hypotheses.
std::optional<Drift> drift_of(const Hypothesis& hypothesis, const estimate::Outcome& outcome) {
  if (hypothesis.candidate.term.term != kDrift || !hypothesis.candidate.laser()) return {};
  const auto places = parameter_indices(hypothesis.candidate, outcome);
  if (places.size() != 2 || !places[0] || !places[1]) return {};
  return Drift{.skew = estimated(outcome, *places[0]), .growth = estimated(outcome, *places[1])};
}

}  // namespace

std::vector<double> skew_errors(const Rig& rig, const std::map<std::string, ClockMap>& clocks) {
  const auto error_of = [&](const std::string& device) {
    const auto clock = clocks.find(device);
    return clock == clocks.end() ? 0 : clock->second.skew_std_error;
  };
  std::vector<double> errors;
  for (const RigLaser& laser : rig.lasers)
    errors.push_back(std::hypot(error_of(laser.name), error_of(rig.plate.name)));
  return errors;
}

void mark_clock_lines(std::vector<Hypothesis>& hypotheses, const estimate::Outcome& outcome,
                      const std::vector<double>& skew_errors, double middle, double least_chi2) {
  for (Hypothesis& one : hypotheses) {
    const auto drift = one.accepted ? drift_of(one, outcome) : std::nullopt;
    if (!drift || one.candidate.owner >= skew_errors.size()) continue;
    const double mean = drift->skew.value + drift->growth.value * middle;
    const bool is_constant = std::pow(drift->growth.value / drift->growth.std_error, 2) < least_chi2;
    const double error = std::hypot(drift->skew.std_error, skew_errors[one.candidate.owner]);
    one.is_clock_line = is_constant && std::abs(mean) < kLineErrors * error;
  }
}

std::optional<EstimatorArtifact> clock_lines(const std::vector<Hypothesis>& hypotheses,
                                             const estimate::Outcome& outcome) {
  EstimatorArtifact found{
      .name = "clock_line",
      .parameters = {},
      .reason =
          "the rates of clocks from the telegrams' delays are off by less than three of their standard errors. The values are the corrections by the surfaces. Telegrams with shorter delays, or a longer recording, determine the rates better"};
  for (const Hypothesis& one : hypotheses) {
    if (one.is_clock_line) found.parameters.push_back(drift_of(one, outcome)->skew);
  }
  if (found.parameters.empty()) return {};
  return found;
}

}  // namespace crisp::diagnose
