// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/forms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plugins/diagnose/beside.hpp"

namespace crisp {
namespace {

/// Looks at some forms of one candidate, each beside the others.
std::vector<Look> looks_at(const std::vector<Candidate>& forms, const std::vector<Candidate>& others,
                           const SensorModel& model, const std::vector<std::size_t>& base,
                           const Evidence& evidence, std::size_t beams, const TermRegistry& terms) {
  std::vector<Candidate> all = forms;
  all.insert(all.end(), others.begin(), others.end());
  std::vector<std::size_t> taken(others.size());
  std::iota(taken.begin(), taken.end(), forms.size());
  const Dictionary dictionary(model, base, all, terms);
  const auto found =
      looks_beside(taken, dictionary, from_neutral(dictionary, evidence.equations(dictionary, beams)));
  std::vector<Look> looks;
  for (std::size_t k = 0; k < forms.size(); ++k) looks.push_back(*found[k]);
  return looks;
}

std::size_t best_of(const std::vector<Look>& looks) {
  return static_cast<std::size_t>(std::ranges::max_element(looks, {}, &Look::gain) - looks.begin());
}

Eigen::VectorXd values_of(const Candidate& candidate) {
  const auto& parameters = candidate.term.parameters;
  Eigen::VectorXd values(static_cast<Eigen::Index>(parameters.size()));
  std::ranges::transform(parameters, values.begin(), &Parameter::value);
  return values;
}

/// All forms that are tried, beside the best.
std::vector<Candidate::OtherForm> other_forms(const Candidate& best, const std::vector<Candidate>& others,
                                              const SensorModel& model, const std::vector<std::size_t>& base,
                                              const Evidence& evidence, std::size_t beams,
                                              const TermRegistry& terms) {
  std::vector<Candidate> forms = {best};
  for (std::size_t k = 0; k < best.forms; ++k) {
    forms.push_back(in_form(best, static_cast<double>(k), terms, evidence.coverage()));
  }
  const std::vector<Look> looks = looks_at(forms, others, model, base, evidence, beams, terms);
  const Eigen::VectorXd values = values_of(valued(best, looks.front(), terms));
  std::vector<Candidate::OtherForm> result;
  for (std::size_t k = 1; k < forms.size(); ++k) {
    result.push_back({.off = values_of(valued(forms[k], looks[k], terms)) - values,
                      .behind = std::max(0.0, looks.front().gain - looks[k].gain)});
  }
  return result;
}

}  // namespace

std::vector<Candidate> with_sharper_forms(std::vector<Candidate> chosen, const SensorModel& model,
                                          const std::vector<std::size_t>& base, const Evidence& evidence,
                                          std::size_t beams, const TermRegistry& terms) {
  constexpr int kZooms = 3;
  constexpr int kHalf = 4;  // forms to either side
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    if (chosen[c].in_model || chosen[c].forms < 2) continue;
    std::vector<Candidate> others = chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(c));
    double step = 1;
    for (int zoom = 0; zoom < kZooms; ++zoom) {
      step /= kHalf;
      std::vector<Candidate> forms;
      for (int k = -kHalf; k <= kHalf; ++k) {
        forms.push_back(in_form(chosen[c], chosen[c].form + k * step, terms, evidence.coverage()));
      }
      chosen[c] = forms[best_of(looks_at(forms, others, model, base, evidence, beams, terms))];
    }
    chosen[c].other_forms = other_forms(chosen[c], others, model, base, evidence, beams, terms);
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

}  // namespace crisp
