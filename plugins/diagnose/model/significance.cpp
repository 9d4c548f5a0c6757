// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/significance.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <map>
#include <string>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp {
namespace {

constexpr const char* kMayBeTheScenes =
    "several lasers share it, and it is small: deviations of real surfaces from planes make effects of this size";
constexpr const char* kIsNothing =
    "it is not significant in the joint fit with the other accepted effects (Wald test)";

/// Wald test: p-value of the estimate for a term that is neutral; 0 if none of its parameters was
/// estimated. The form is held at its estimate, since a neutral term has none, and counts as a parameter.
double chance_of_neutral(const Candidate& candidate, const Outcome& outcome, const TermInfo& info) {
  const auto places = parameter_indices(candidate, outcome);
  std::vector<Eigen::Index> at;
  std::vector<Eigen::Index> form;
  std::vector<double> off;
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (!places[p]) continue;
    if (info.parameters[p].shape) {
      form.push_back(*places[p]);
      continue;
    }
    at.push_back(*places[p]);
    off.push_back(
        outcome.model
            .values()[static_cast<Eigen::Index>(outcome.free[static_cast<std::size_t>(*places[p])])] -
        info.parameters[p].neutral);
  }
  if (at.empty()) return 0;
  Eigen::MatrixXd covariance = outcome.covariance(at, at);
  if (!form.empty()) {
    const Eigen::MatrixXd with_form = outcome.covariance(form, at);
    const Eigen::MatrixXd of_form = outcome.covariance(form, form);
    covariance -= with_form.transpose() * solve_positive_definite(of_form, with_form);
  }
  const Eigen::VectorXd change =
      Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size()));
  const double square = change.dot(solve_positive_definite(covariance, change));
  if (!(square > 0)) return 1;
  return cdf(complement(boost::math::chi_squared(static_cast<double>(off.size() + form.size())), square));
}

}  // namespace

std::vector<std::optional<Eigen::Index>> parameter_indices(const Candidate& candidate,
                                                           const Outcome& outcome) {
  std::vector<std::optional<Eigen::Index>> places(candidate.term.parameters.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    const std::string name =
        (candidate.laser() ? "" : "plate.") + candidate.name + "." + candidate.term.parameters[p].name;
    for (std::size_t k = 0; k < outcome.free.size(); ++k) {
      if (outcome.model.names()[outcome.free[k]] == name) places[p] = static_cast<Eigen::Index>(k);
    }
  }
  return places;
}

void reject_scene_artifacts(std::vector<Hypothesis>& hypotheses) {
  constexpr double kOfScenes = 0.1;  // [σ] RMS effect of non-planar surfaces
  std::map<std::string, std::vector<Hypothesis*>> alike;
  for (Hypothesis& one : hypotheses) {
    if (one.accepted && one.candidate.laser()) alike[one.candidate.term.term].push_back(&one);
  }
  for (const auto& [term, some] : alike) {
    const bool is_large =
        std::ranges::any_of(some, [](const Hypothesis* one) { return one->test.visible > kOfScenes; });
    if (some.size() < 2 || is_large) continue;
    for (Hypothesis* one : some) one->reject(kMayBeTheScenes);
  }
}

bool reject_insignificant(std::vector<Hypothesis>& hypotheses, const Outcome& outcome,
                          const TermRegistry& terms, double p_value) {
  bool has_rejected = false;
  for (Hypothesis& one : hypotheses) {
    if (!one.accepted) continue;
    const TermInfo& info = terms.get(one.candidate.term.term)->info();
    if (chance_of_neutral(one.candidate, outcome, info) < p_value) continue;
    one.reject(kIsNothing);
    has_rejected = true;
  }
  return has_rejected;
}

}  // namespace crisp
