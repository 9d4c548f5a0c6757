// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/conditional_score_test.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/estimate/observability.hpp"

namespace crisp::diagnose {
namespace {

using quality::NormalEquations;

/// Parameters estimated jointly with the tested ones: the base's and those of selected candidates.
std::vector<std::size_t> estimated_with(const std::vector<std::size_t>& taken,
                                        const CandidateJacobian& jacobian) {
  std::vector<std::size_t> parameters(jacobian.base());
  std::iota(parameters.begin(), parameters.end(), std::size_t{0});
  for (const std::size_t t : taken) {
    parameters.insert(parameters.end(), jacobian.of(t).begin(), jacobian.of(t).end());
  }
  return parameters;
}

}  // namespace

NormalEquations from_neutral(const CandidateJacobian& jacobian, NormalEquations equations) {
  Eigen::VectorXd back = Eigen::VectorXd::Zero(equations.vector.size());
  for (std::size_t c = 0; c < jacobian.candidates().size(); ++c) {
    if (jacobian.candidates()[c].in_model) back(jacobian.of(c)) = -jacobian.sizes_of(c);
  }
  equations.chi2 += 2 * equations.vector.dot(back) + back.dot(equations.matrix * back);
  equations.vector += equations.matrix * back;
  return equations;
}

NormalEquations eliminate_base(const std::vector<std::size_t>& taken, const CandidateJacobian& jacobian,
                               const NormalEquations& equations) {
  std::vector<std::size_t> all(jacobian.parameters());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return equations.reduced(all, estimated_with(taken, jacobian));
}

namespace {

std::vector<std::size_t> columns_of(const std::vector<std::size_t>& some, const CandidateJacobian& jacobian) {
  std::vector<std::size_t> columns;
  for (const std::size_t c : some)
    columns.insert(columns.end(), jacobian.of(c).begin(), jacobian.of(c).end());
  return columns;
}

}  // namespace

double price_of_forms(const std::vector<std::size_t>& some, const CandidateJacobian& jacobian,
                      std::size_t beams) {
  const auto forms =
      std::ranges::count_if(some, [&](std::size_t c) { return jacobian.candidates()[c].forms > 1; });
  return static_cast<double>(forms) * std::log(static_cast<double>(beams));
}

ScoreTest joint_score_test(const std::vector<std::size_t>& some, const CandidateJacobian& jacobian,
                           const NormalEquations& left) {
  ScoreTest test = score_test(left, columns_of(some, jacobian));
  test.bic -= price_of_forms(some, jacobian, left.beams);
  return test;
}

NormalEquations equations_given(const std::vector<std::size_t>& taken, const std::vector<std::size_t>& some,
                                const CandidateJacobian& jacobian, const NormalEquations& equations) {
  return equations.reduced(columns_of(some, jacobian), estimated_with(taken, jacobian));
}

ScoreTest joint_score_test_given(const std::vector<std::size_t>& taken, const std::vector<std::size_t>& some,
                                 const CandidateJacobian& jacobian, const NormalEquations& equations) {
  const NormalEquations left = equations_given(taken, some, jacobian, equations);
  std::vector<std::size_t> all(static_cast<std::size_t>(left.vector.size()));
  std::iota(all.begin(), all.end(), std::size_t{0});
  ScoreTest test = score_test(left, all);
  test.bic -= price_of_forms(some, jacobian, left.beams);
  return test;
}

std::vector<std::optional<ScoreTest>> score_tests(const NormalEquations& left,
                                                  const std::vector<std::size_t>& taken,
                                                  const CandidateJacobian& jacobian) {
  const auto& candidates = jacobian.candidates();
  std::vector<std::optional<ScoreTest>> tests(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const bool there =
        std::ranges::any_of(taken, [&](std::size_t t) { return candidates[t].is_form_of(candidates[c]); });
    if (!there) tests[c] = joint_score_test({c}, jacobian, left);
  }
  return tests;
}

std::vector<std::optional<ScoreTest>> score_tests_given(const std::vector<std::size_t>& taken,
                                                        const CandidateJacobian& jacobian,
                                                        const NormalEquations& equations) {
  return score_tests(eliminate_base(taken, jacobian, equations), taken, jacobian);
}

std::string known_instead(std::size_t candidate, const std::vector<std::size_t>& taken,
                          const CandidateJacobian& jacobian, const NormalEquations& equations) {
  constexpr double kNothing = 1e-3;  // share of a parameter's squared effect
  constexpr double kLittle = 0.05;   // share of the effect after the fit of planes
  const std::vector<std::size_t> known = estimated_with(taken, jacobian);
  const Eigen::VectorXd scale =
      equations.squares.unaryExpr([](double square) { return square > 0 ? 1 / std::sqrt(square) : 0.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * equations.matrix * scale.asDiagonal();
  const std::vector<std::size_t>& own = jacobian.of(candidate);
  const Eigen::MatrixXd left = equations.reduced(own, known).matrix;
  std::string text;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(own[k]);
    const auto at = static_cast<Eigen::Index>(k);
    if (scaled(i, i) < kNothing || left(at, at) > kLittle * equations.matrix(i, i)) continue;
    const std::string combination = estimate::known_with(own[k], known, scaled, jacobian.names(), scale);
    text += (text.empty() || combination.empty() ? "" : "; ") + combination;
  }
  return text;
}

}  // namespace crisp::diagnose
