// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/clock_lines.hpp"

#include <cmath>

#include <crisp/effect_catalogue.hpp>

#include "pipeline/estimate/requested_terms.hpp"

namespace crisp::diagnose {
namespace {

constexpr const char* kTerm = "clock.skew";

std::string parameter_of(const std::string& laser) { return laser + "." + kTerm + ".skew"; }

void remove_lines(Calibration& calibration) {
  for (LaserCalibration& laser : calibration.lasers)
    std::erase_if(laser.terms, [](const TermParameters& one) { return one.term == kTerm; });
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

void add_clock_lines(Calibration& calibration, estimate::ParameterPrior& prior,
                     const std::vector<double>& errors, double middle, const TermRegistry& terms) {
  TermParameters term = neutral_parameters(terms.get(kTerm)->info());
  term.parameters[1].value = middle;
  remove_lines(calibration);
  for (std::size_t laser = 0; laser < calibration.lasers.size(); ++laser) {
    LaserCalibration& own = calibration.lasers[laser];
    if (!(errors[laser] > 0) || !std::isfinite(errors[laser])) continue;
    own.terms.push_back(term);
    prior.nominal[parameter_of(own.name)] = {.value = 0, .std_error = errors[laser]};
  }
}

estimate::Outcome without_clock_lines(const estimate::Outcome& outcome, const TermRegistry& terms) {
  Calibration calibration = outcome.model.calibration();
  remove_lines(calibration);
  estimate::Outcome without = outcome;
  without.model = SensorModel(calibration, terms);
  without.free.clear();
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const std::string& name = outcome.model.names()[outcome.free[k]];
    const auto same = std::ranges::find(without.model.names(), name);
    if (same == without.model.names().end()) continue;
    kept.push_back(k);
    without.free.push_back(static_cast<std::size_t>(same - without.model.names().begin()));
  }
  without.covariance = Eigen::MatrixXd(outcome.covariance(kept, kept));
  return without;
}

std::optional<EstimatorArtifact> clock_lines(const estimate::Outcome& outcome,
                                             const estimate::ParameterPrior& prior) {
  constexpr double kBetter = 0.5;  // of the stamps' standard error
  EstimatorArtifact found{
      .name = "clock_line",
      .parameters = {},
      .reason =
          "the surfaces determine the rates of these clocks better than the delays of their telegrams do. The values are the corrections of the rates. Telegrams with shorter delays, or a longer recording, determine them better"};
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const std::size_t parameter = outcome.free[k];
    const std::string& name = outcome.model.names()[parameter];
    const auto known = prior.nominal.find(name);
    if (known == prior.nominal.end() || !name.ends_with(std::string(".") + kTerm + ".skew")) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const double error = std::sqrt(outcome.covariance(i, i));
    if (error > kBetter * known->second.std_error) continue;
    found.parameters.push_back({.name = name,
                                .unit = "1",
                                .value = outcome.model.values()[static_cast<Eigen::Index>(parameter)],
                                .std_error = error});
  }
  if (found.parameters.empty()) return {};
  return found;
}

}  // namespace crisp::diagnose
