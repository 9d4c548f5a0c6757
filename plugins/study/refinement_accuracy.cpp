// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/refinement_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::study {
namespace {

/// The errors of `parameters`, as far as they were turned.
Eigen::VectorXd errors_of(const estimate::Outcome& outcome, const std::vector<std::string>& parameters) {
  Eigen::VectorXd errors = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(parameters.size()),
                                                     std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const auto found = std::ranges::find(parameters, outcome.model.names()[outcome.free[k]]);
    const auto at = static_cast<Eigen::Index>(k);
    if (found != parameters.end()) errors[found - parameters.begin()] = std::sqrt(outcome.covariance(at, at));
  }
  return errors;
}

}  // namespace

RefinementAccuracy refinement_accuracy(const simulate::ScannerSettings& scanner, const simulate::Scene& scene,
                                       const simulate::Motion& motion, BeamChoice beams,
                                       const std::vector<std::string>& parameters,
                                       const TermRegistry& terms) {
  const auto simulated = simulate_beams(beams, scanner, scene, motion, terms);
  const estimate::Sample sample{.beams = simulated.beams, .plate = &simulated.plate};
  estimate::RefinementSettings settings;
  settings.surfels.noise = scanner.range.sigma;
  try {
    const estimate::Refinement found =
        estimate::refine_by_surfels(SensorModel(simulated.truth, terms), sample, settings);
    return {.std_errors = errors_of(found.outcome, parameters),
            .beams = found.beams,
            .surfaces = found.surfels,
            .failure = {}};
  } catch (const Error& error) {
    return {.std_errors = {}, .failure = error.message()};
  }
}

}  // namespace crisp::study
