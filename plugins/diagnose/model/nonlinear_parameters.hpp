// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"

namespace crisp::diagnose {

/// Refines the forms of the candidates (nonlinear parameters such as a period or an instant) by a shrinking
/// grid search, each jointly with all other candidates. Candidates that the model already has keep their
/// form. The others get the list of their evaluated forms.
///
/// @param base   indices of the base parameters (λ, τ, α, η) that are estimated jointly
/// @param beams  number of beams in the tests
std::vector<Candidate> refine_nonlinear(std::vector<Candidate> chosen, const SensorModel& model,
                                        const std::vector<std::size_t>& base,
                                        const SurfaceObservations& observations, std::size_t beams,
                                        const TermRegistry& terms);

/// Covariance of a term's parameters over its forms, weighted by likelihood (Bayesian model averaging). A
/// form on which a small part of an effect depends (a sway next to a larger drift) has distant competitors,
/// which the curvature at the optimum does not show. The effect's size may depend on its form, too.
///
/// @param sharing  ScoreTest::design_effect() of the candidate in the model
/// @return         p × p, in the order and units of the term's parameters; empty if no other form was
/// evaluated
Eigen::MatrixXd form_covariance(const std::vector<Candidate::OtherForm>& others, double sharing);

}  // namespace crisp::diagnose
