// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/nonlinear_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plugins/diagnose/model/conditional_score_test.hpp"

namespace crisp::diagnose {
namespace {

/// Score test of each form of one candidate, given the other candidates.
std::vector<ScoreTest> tests_of(const std::vector<Candidate>& forms, const std::vector<Candidate>& others,
                                const SensorModel& model, const std::vector<std::size_t>& base,
                                const SurfaceObservations& observations, std::size_t beams,
                                const TermRegistry& terms) {
  std::vector<Candidate> all = forms;
  all.insert(all.end(), others.begin(), others.end());
  std::vector<std::size_t> taken(others.size());
  std::iota(taken.begin(), taken.end(), forms.size());
  const CandidateJacobian jacobian(model, base, all, terms);
  const auto found =
      score_tests_given(taken, jacobian, from_neutral(jacobian, observations.equations(jacobian, beams)));
  std::vector<ScoreTest> tests;
  for (std::size_t k = 0; k < forms.size(); ++k) tests.push_back(*found[k]);
  return tests;
}

std::size_t best_of(const std::vector<ScoreTest>& tests) {
  return static_cast<std::size_t>(std::ranges::max_element(tests, {}, &ScoreTest::gain) - tests.begin());
}

Eigen::VectorXd values_of(const Candidate& candidate) {
  const auto& parameters = candidate.term.parameters;
  Eigen::VectorXd values(static_cast<Eigen::Index>(parameters.size()));
  std::ranges::transform(parameters, values.begin(), &Parameter::value);
  return values;
}

/// Evaluates all forms of the grid against the best one.
std::vector<Candidate::OtherForm> other_forms(const Candidate& best, const std::vector<Candidate>& others,
                                              const SensorModel& model, const std::vector<std::size_t>& base,
                                              const SurfaceObservations& observations, std::size_t beams,
                                              const TermRegistry& terms) {
  std::vector<Candidate> forms = {best};
  for (std::size_t k = 0; k < best.forms; ++k) {
    forms.push_back(in_form(best, static_cast<double>(k), terms, observations.coverage()));
  }
  const std::vector<ScoreTest> tests = tests_of(forms, others, model, base, observations, beams, terms);
  const Eigen::VectorXd values = values_of(with_estimates(best, tests.front(), terms));
  std::vector<Candidate::OtherForm> result;
  for (std::size_t k = 1; k < forms.size(); ++k) {
    result.push_back({.off = values_of(with_estimates(forms[k], tests[k], terms)) - values,
                      .behind = std::max(0.0, tests.front().gain - tests[k].gain)});
  }
  return result;
}

}  // namespace

std::vector<Candidate> refine_nonlinear(std::vector<Candidate> chosen, const SensorModel& model,
                                        const std::vector<std::size_t>& base,
                                        const SurfaceObservations& observations, std::size_t beams,
                                        const TermRegistry& terms) {
  constexpr int kZooms = 3;
  constexpr int kHalf = 4;  // forms on either side of the best
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    if (chosen[c].in_model || chosen[c].forms < 2) continue;
    std::vector<Candidate> others = chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(c));
    double step = 1;
    for (int zoom = 0; zoom < kZooms; ++zoom) {
      step /= kHalf;
      std::vector<Candidate> forms;
      for (int k = -kHalf; k <= kHalf; ++k) {
        forms.push_back(in_form(chosen[c], chosen[c].form + k * step, terms, observations.coverage()));
      }
      chosen[c] = forms[best_of(tests_of(forms, others, model, base, observations, beams, terms))];
    }
    chosen[c].other_forms = other_forms(chosen[c], others, model, base, observations, beams, terms);
  }
  return chosen;
}

Eigen::MatrixXd form_covariance(const std::vector<Candidate::OtherForm>& others, double sharing) {
  if (others.empty()) return {};
  const Eigen::Index p = others.front().off.size();
  double likelihoods = 1;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(p, p);
  for (const auto& other : others) {
    const double likelihood = std::exp(-other.behind / sharing / 2);
    likelihoods += likelihood;
    squares += likelihood * other.off * other.off.transpose();
  }
  return squares / likelihoods;
}

}  // namespace crisp::diagnose
