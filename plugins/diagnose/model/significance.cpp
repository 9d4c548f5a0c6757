// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/significance.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <functional>
#include <map>
#include <string>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::diagnose {
namespace {

constexpr const char* kMayBeTheScenes =
    "several lasers share it, and it is small: deviations of real surfaces from planes make effects of this size";
constexpr const char* kIsNothing = "it is not significant in the joint fit with the other accepted effects";

std::string name_in_model(const Candidate& candidate, std::size_t parameter) {
  return (candidate.laser() ? "" : "plate.") + candidate.name + "." +
         candidate.term.parameters[parameter].name;
}

/// Parameters of a candidate in a joint fit.
struct Estimates {
  std::vector<Eigen::Index> at;    ///< estimated sizes
  std::vector<Eigen::Index> form;  ///< estimated shape parameters
  std::vector<double> off;         ///< of the sizes, from neutral
  bool has_held = false;           ///< whether a size is held at a value that is not neutral
};

Estimates estimates_of(const Candidate& candidate, const estimate::Outcome& outcome, const TermInfo& info) {
  Estimates estimates;
  const auto places = parameter_indices(candidate, outcome);
  for (std::size_t p = 0; p < places.size(); ++p) {
    const EffectParameter& parameter = info.parameters[p];
    const std::size_t index = outcome.model.index(name_in_model(candidate, p));
    const double off = outcome.model.values()[static_cast<Eigen::Index>(index)] - parameter.neutral;
    if (!places[p]) {
      estimates.has_held = estimates.has_held || (!parameter.shape && off != 0);
    } else if (parameter.shape) {
      estimates.form.push_back(*places[p]);
    } else {
      estimates.at.push_back(*places[p]);
      estimates.off.push_back(off);
    }
  }
  return estimates;
}

/// Wald test of the estimate under the null hypothesis of a neutral term. A term passes of which no parameter
/// was estimated. The form is held at its estimate, since a neutral term has none, and counts as a parameter.
///
/// @param p_value  largest that passes
AcceptanceTest wald_test(const Estimates& estimates, const estimate::Outcome& outcome, double p_value) {
  AcceptanceTest test{.name = "Wald test", .threshold = p_value, .p_value = 0, .passed = true};
  const auto& [at, form, off, has_held] = estimates;
  if (at.empty()) return test;
  Eigen::MatrixXd covariance = outcome.covariance(at, at);
  if (!form.empty()) {
    const Eigen::MatrixXd with_form = outcome.covariance(form, at);
    const Eigen::MatrixXd of_form = outcome.covariance(form, form);
    covariance -= with_form.transpose() * statistics::solve_positive_definite(of_form, with_form);
  }
  const Eigen::VectorXd change =
      Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size()));
  test.statistic = change.dot(statistics::solve_positive_definite(covariance, change));
  const boost::math::chi_squared null(static_cast<double>(off.size() + form.size()));
  test.p_value = test.statistic > 0 ? cdf(complement(null, test.statistic)) : 1;
  test.passed = test.p_value < p_value;
  return test;
}

/// Test of a term of which some parameters are held at their estimates: the others' null hypothesis says
/// nothing of the term, but the score test's has all of them neutral.
AcceptanceTest score_test_of(const Hypothesis& hypothesis, double p_value) {
  return {.name = "score test",
          .statistic = hypothesis.test.wald,
          .threshold = p_value,
          .p_value = hypothesis.test.p_value,
          .passed = hypothesis.test.p_value < p_value};
}

}  // namespace

std::vector<std::optional<Eigen::Index>> parameter_indices(const Candidate& candidate,
                                                           const estimate::Outcome& outcome) {
  std::vector<std::optional<Eigen::Index>> places(candidate.term.parameters.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    const std::string name = name_in_model(candidate, p);
    for (std::size_t k = 0; k < outcome.free.size(); ++k) {
      if (outcome.model.names()[outcome.free[k]] == name) places[p] = static_cast<Eigen::Index>(k);
    }
  }
  return places;
}

void reject_scene_artifacts(std::vector<Hypothesis>& hypotheses) {
  constexpr double kOfScenes = 0.1;  // [σ] RMS effect of non-planar surfaces
  constexpr double kTimes = 2;       // more than lasers that see the same surfaces differ in it
  const auto visible_of = [](const Hypothesis* one) { return one->test.visible; };
  std::map<std::string, std::vector<Hypothesis*>> alike;
  for (Hypothesis& one : hypotheses) {
    if (one.accepted && one.candidate.laser()) alike[one.candidate.term.term].push_back(&one);
  }
  for (auto& [term, some] : alike) {
    if (some.size() < 2) continue;
    std::ranges::sort(some, std::greater{}, visible_of);
    const double largest = some[0]->test.visible;
    const double of_others = kTimes * some[1]->test.visible;
    for (Hypothesis* one : some) {
      if (one == some[0] && largest > of_others) {
        one->decide({.name = "size against twice that of other lasers [noise]",
                     .statistic = largest,
                     .threshold = of_others,
                     .passed = true},
                    {});
        continue;
      }
      one->decide({.name = "size common to lasers [noise]",
                   .statistic = largest,
                   .threshold = kOfScenes,
                   .passed = largest > kOfScenes},
                  kMayBeTheScenes);
    }
  }
}

bool reject_insignificant(std::vector<Hypothesis>& hypotheses, const estimate::Outcome& outcome,
                          const TermRegistry& terms, double p_value) {
  bool has_rejected = false;
  for (Hypothesis& one : hypotheses) {
    if (!one.accepted) continue;
    const TermInfo& info = terms.get(one.candidate.term.term)->info();
    const Estimates estimates = estimates_of(one.candidate, outcome, info);
    one.decide(estimates.has_held ? score_test_of(one, p_value) : wald_test(estimates, outcome, p_value),
               kIsNothing);
    has_rejected = has_rejected || !one.accepted;
  }
  return has_rejected;
}

}  // namespace crisp::diagnose
