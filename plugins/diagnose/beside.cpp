// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/beside.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/estimate/observability.hpp"

namespace crisp {
namespace {

/// The parameters that are estimated beside whatever is looked at: the base's, and those of what was taken.
std::vector<std::size_t> estimated_with(const std::vector<std::size_t>& taken, const Dictionary& dictionary) {
  std::vector<std::size_t> parameters(dictionary.base());
  std::iota(parameters.begin(), parameters.end(), std::size_t{0});
  for (const std::size_t t : taken) {
    parameters.insert(parameters.end(), dictionary.of(t).begin(), dictionary.of(t).end());
  }
  return parameters;
}

}  // namespace

NormalEquations from_neutral(const Dictionary& dictionary, NormalEquations equations) {
  Eigen::VectorXd back = Eigen::VectorXd::Zero(equations.vector.size());
  for (std::size_t c = 0; c < dictionary.candidates().size(); ++c) {
    if (dictionary.candidates()[c].in_model) back(dictionary.of(c)) = -dictionary.sizes_of(c);
  }
  equations.chi2 += 2 * equations.vector.dot(back) + back.dot(equations.matrix * back);
  equations.vector += equations.matrix * back;
  return equations;
}

NormalEquations beside_base(const std::vector<std::size_t>& taken, const Dictionary& dictionary,
                            const NormalEquations& equations) {
  std::vector<std::size_t> all(dictionary.parameters());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return equations.reduced(all, estimated_with(taken, dictionary));
}

Look look_together(const std::vector<std::size_t>& some, const Dictionary& dictionary,
                   const NormalEquations& left) {
  std::vector<std::size_t> parameters;
  double forms = 0;
  for (const std::size_t c : some) {
    parameters.insert(parameters.end(), dictionary.of(c).begin(), dictionary.of(c).end());
    forms += dictionary.candidates()[c].forms > 1 ? 1 : 0;
  }
  Look look = look_at(left, parameters);
  look.bic -= forms * std::log(static_cast<double>(left.beams));
  return look;
}

std::vector<std::optional<Look>> looks_in(const NormalEquations& left, const std::vector<std::size_t>& taken,
                                          const Dictionary& dictionary) {
  const auto& candidates = dictionary.candidates();
  std::vector<std::optional<Look>> looks(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const bool there =
        std::ranges::any_of(taken, [&](std::size_t t) { return candidates[t].is_form_of(candidates[c]); });
    if (!there) looks[c] = look_together({c}, dictionary, left);
  }
  return looks;
}

std::vector<std::optional<Look>> looks_beside(const std::vector<std::size_t>& taken,
                                              const Dictionary& dictionary,
                                              const NormalEquations& equations) {
  return looks_in(beside_base(taken, dictionary, equations), taken, dictionary);
}

std::string known_instead(std::size_t candidate, const std::vector<std::size_t>& taken,
                          const Dictionary& dictionary, const NormalEquations& equations) {
  constexpr double kNothing = 1e-3;  // left of the squares of what a parameter does
  constexpr double kLittle = 0.05;   // left of what planes leave
  const std::vector<std::size_t> known = estimated_with(taken, dictionary);
  const Eigen::VectorXd scale =
      equations.squares.unaryExpr([](double square) { return square > 0 ? 1 / std::sqrt(square) : 0.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * equations.matrix * scale.asDiagonal();
  const std::vector<std::size_t>& own = dictionary.of(candidate);
  const Eigen::MatrixXd left = equations.reduced(own, known).matrix;
  std::string text;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(own[k]);
    const auto at = static_cast<Eigen::Index>(k);
    if (scaled(i, i) < kNothing || left(at, at) > kLittle * equations.matrix(i, i)) continue;
    const std::string combination = known_with(own[k], known, scaled, dictionary.names(), scale);
    text += (text.empty() || combination.empty() ? "" : "; ") + combination;
  }
  return text;
}

}  // namespace crisp
