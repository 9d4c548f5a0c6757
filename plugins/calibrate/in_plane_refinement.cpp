// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/in_plane_refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "pipeline/data/error.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "plugins/calibrate/observability.hpp"
#include "plugins/calibrate/placed_beams.hpp"
#include "plugins/calibrate/surfel_rows.hpp"
#include "plugins/calibrate/upright.hpp"

namespace crisp {
namespace {

/// Decides anew which wall each beam met.
Surfels renewed(const Surfels& known, const BeamsView& beams, const InPlaneRefinementSettings& settings) {
  Surfels walls = claimed(known, beams, settings.surfels, settings.claims);
  if (walls.surfels.empty()) throw Error("no flat wall is seen by the beams in the plate's plane");
  return walls;
}

void refuse_unknown(const NormalEquations& equations, const SensorModel& model,
                    const std::vector<std::size_t>& free, const SearchRange& prior) {
  const auto unknown = observability(equations.matrix / equations.covariance_factor(), free, model.names(),
                                     ranges_of(prior, model, free))
                           .unobservable;
  if (unknown.empty()) return;
  throw Error("the beams in the plate's plane do not determine " + unknown.front().parameter,
              "let the plate's speed vary, or leave the parameter out");
}

}  // namespace

Refinement refine_in_plane(const SensorModel& start, const Sample& sample,
                           const std::vector<std::size_t>& free, const InPlaneRefinementSettings& settings) {
  const Sample upright = spread_upright(sample, settings.spread);
  Refinement result{.outcome = {.model = start, .free = free, .covariance = {}, .unobservable = {}}};
  SensorModel& model = result.outcome.model;
  Surfels walls;
  while (!result.converged && result.rounds < settings.max_rounds) {
    const PlacedBeams placed(model, upright);
    if (result.rounds < settings.searches) walls = find_surfels(placed.view(), settings.surfels);
    if (result.rounds < settings.renewals) walls = renewed(walls, placed.view(), settings);
    for (Surfel& wall : walls.surfels) refine(wall, walls, placed.view(), settings.surfels);
    const NormalEquations equations = normal_equations(walls, placed.view(), free.size(),
                                                       surfel_rows(model, upright, free), settings.surfels);
    refuse_unknown(equations, model, free, settings.prior);
    const auto information = equations.matrix.ldlt();
    const Eigen::VectorXd step = -information.solve(equations.vector);
    model = with(model, free, picked(model, free) + step);
    result.outcome.covariance = equations.covariance_factor() *
                                information.solve(Eigen::MatrixXd::Identity(step.size(), step.size()));
    result.surfels = walls.surfels.size();
    result.beams = equations.beams;
    result.chi2 = equations.chi2 / std::max(1.0, equations.freedom);
    const auto errors = result.outcome.covariance.diagonal().array().sqrt();
    result.converged =
        ++result.rounds > settings.renewals && (step.array() / errors).abs().maxCoeff() < settings.tolerance;
  }
  return result;
}

}  // namespace crisp
