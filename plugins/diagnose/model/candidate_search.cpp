// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/candidate_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "pipeline/estimate/requested_terms.hpp"
#include "plugins/diagnose/model/conditional_score_test.hpp"

namespace crisp::diagnose {

std::vector<std::size_t> base_of(const estimate::Refinement& refinement) {
  std::vector<std::size_t> base;
  for (const std::size_t parameter : refinement.outcome.free) {
    if (estimate::is_of_base_model(refinement.outcome.model, parameter)) base.push_back(parameter);
  }
  // Held parameters may have errors, which no candidate may explain.
  for (const Unobservable& held : refinement.outcome.unobservable) {
    const std::size_t parameter = refinement.outcome.model.index(held.parameter);
    if (estimate::is_of_base_model(refinement.outcome.model, parameter)) base.push_back(parameter);
  }
  return base;
}

namespace {

std::vector<Hypothesis::Competitor> competitors(const SelectedCandidate& choice,
                                                const CandidateJacobian& jacobian) {
  constexpr std::size_t kMax = 5;
  std::vector<Hypothesis::Competitor> result;
  for (const CompetingCandidate& other : choice.alternatives) {
    if (result.size() == kMax) break;
    const Candidate& candidate = jacobian.candidates()[other.candidate];
    result.push_back({.name = candidate.cause_name(),
                      .behind = other.behind,
                      .term = candidate.family,
                      .owner = candidate.owner});
  }
  return result;
}

/// [m] Detection limit: largest RMS change of ranges by a candidate that is not selected, because it is not
/// significant or because the other parameters absorb its effect.
double limit_of(const Candidate& candidate, const ScoreTest& test, const SelectionSettings& settings,
                std::size_t beams) {
  const auto parameters = static_cast<double>(test.value.size()) + (candidate.forms > 1 ? 1 : 0);
  const double significant =
      std::sqrt(settings.bic + parameters * std::log(static_cast<double>(beams))) * test.ranges_error;
  return test.visible > 0 ? std::max(significant, test.ranges * settings.visible / test.visible)
                          : std::numeric_limits<double>::infinity();
}

std::vector<std::size_t> in_model(const std::vector<Candidate>& candidates) {
  std::vector<std::size_t> some;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (candidates[c].in_model) some.push_back(c);
  }
  return some;
}

/// [m] RMS of the laser's significant deviation over the candidate's covariate; 0 if not significant.
double deviation_over(const Candidate& one, const ProfileComparison& left) {
  const auto profile = std::ranges::find_if(left.profiles, [&](const Profile& other) {
    return other.laser == one.laser() && other.covariate == one.covariate && other.is_significant();
  });
  return profile != left.profiles.end() ? profile->rms : 0;
}

std::vector<Candidate> possible(const TermRegistry& terms, const SensorModel& model, const Coverage& coverage,
                                const std::set<std::string>& excluded, const ProfileComparison& left) {
  auto all = candidates(terms, model.calibration(), coverage);
  std::map<std::size_t, double> most;  // by owner, over the covariates of fine shapes
  for (const Candidate& one : all) {
    if (one.is_fine) most[one.owner] = std::max(most[one.owner], deviation_over(one, left));
  }
  std::erase_if(all, [&](const Candidate& one) {
    const double deviation = deviation_over(one, left);
    const bool is_requested = deviation > 0 && deviation == most[one.owner];
    return excluded.contains(one.name) || (one.is_fine && !one.in_model && !is_requested);
  });
  return all;
}

}  // namespace

CandidateSearch::CandidateSearch(const SurfaceObservations& observations, const estimate::Refinement& at,
                                 const TermRegistry& terms, const DiagnosisSettings& settings,
                                 const ProfileComparison& left)
    : observations_(observations),
      terms_(terms),
      settings_(settings),
      model_(at.outcome.model),
      base_(base_of(at)),
      all_(view(possible(terms, model_, observations.coverage(), settings.excluded, left), settings.beams)) {
  std::set<std::string> names;
  for (const Candidate& candidate : all_.jacobian.candidates()) names.insert(candidate.name);
  tests_ = names.size();
}

CandidateSearch::View CandidateSearch::view(std::vector<Candidate> candidates, std::size_t beams) const {
  CandidateJacobian jacobian(model_, base_, std::move(candidates), terms_);
  quality::NormalEquations equations = from_neutral(jacobian, observations_.equations(jacobian, beams));
  return {.jacobian = std::move(jacobian), .equations = std::move(equations)};
}

std::vector<Hypothesis> CandidateSearch::needs_in(const View& view, const SelectionSettings& selection,
                                                  const std::set<std::string>& rejected) const {
  std::vector<Hypothesis> needs;
  for (const SelectedCandidate& choice : choose(view.jacobian, view.equations, selection, rejected, tests_)) {
    needs.push_back(
        {.candidate = with_estimates(view.jacobian.candidates()[choice.candidate], choice.test, terms_),
         .test = choice.test,
         .competitors = competitors(choice, view.jacobian),
         .gains = {}});
  }
  return needs;
}

std::vector<Hypothesis> CandidateSearch::needs(const std::set<std::string>& rejected) const {
  return needs_in(all_, settings_.selection, rejected);
}

std::vector<Hypothesis> CandidateSearch::needs_of(const std::vector<Candidate>& some) const {
  std::set<std::string> others;
  for (const Candidate& one : all_.jacobian.candidates()) {
    if (std::ranges::find(some, one.name, &Candidate::name) == some.end()) others.insert(one.name);
  }
  return needs_in(all_, settings_.selection, others);
}

/// Screens candidates for the refined search: the model's own, and the best forms of those whose gain exceeds
/// its expectation under the null hypothesis, given the model's candidates or all but one of them.
std::vector<Candidate> CandidateSearch::promising() const {
  const auto& all = all_.jacobian.candidates();
  const auto taken = in_model(all);
  std::set<std::size_t> some(taken.begin(), taken.end());
  const auto add_conditionally_significant = [&](const std::vector<std::size_t>& others) {
    const auto tests = score_tests_given(others, all_.jacobian, all_.equations);
    const auto excess = [&](std::size_t c) {
      return tests[c] ? tests[c]->gain - static_cast<double>(tests[c]->value.size()) : 0.0;
    };
    for (std::size_t c = 0; c < all.size(); ++c) {
      // Of the forms of a candidate, those that no neighbour on the grid surpasses.
      const bool is_surpassed =
          (c > 0 && all[c - 1].is_form_of(all[c]) && excess(c - 1) > excess(c)) ||
          (c + 1 < all.size() && all[c + 1].is_form_of(all[c]) && excess(c + 1) > excess(c));
      if (excess(c) > 0 && !is_surpassed) some.insert(c);
    }
  };
  add_conditionally_significant(taken);
  for (const std::size_t one : taken) {
    auto others = taken;
    std::erase(others, one);
    add_conditionally_significant(others);
  }
  std::vector<Candidate> candidates;
  for (const std::size_t c : some) candidates.push_back(all[c]);
  return candidates;
}

std::vector<Hypothesis> CandidateSearch::refine_search(const std::set<std::string>& rejected) const {
  SelectionSettings selection = settings_.selection;
  selection.visible = settings_.min_effect;
  auto needs = needs_in(view(promising(), settings_.refine_beams), selection, rejected);
  const auto& all = all_.jacobian.candidates();
  const auto is_of_model = [&](const Candidate& one) {
    return std::ranges::any_of(in_model(all), [&](std::size_t c) { return all[c].is_of_family(one); });
  };
  std::erase_if(needs, [&](const Hypothesis& hypothesis) {
    return hypothesis.candidate.is_shape() && !is_of_model(hypothesis.candidate);
  });
  return needs;
}

std::vector<Limit> CandidateSearch::unobservable(const std::vector<Hypothesis>& given) const {
  constexpr double kMuch = 0.25;
  struct Least {
    double limit = 0;
    std::size_t candidate = 0;
  };
  const auto& all = all_.jacobian.candidates();
  std::vector<std::size_t> taken;
  for (std::size_t c = 0; c < all.size(); ++c) {
    const bool is_taken = std::ranges::any_of(given, [&](const Hypothesis& hypothesis) {
      return hypothesis.candidate.is_form_of(all[c]) && hypothesis.candidate.form == all[c].form;
    });
    if (is_taken) taken.push_back(c);
  }
  const auto tests = score_tests_given(taken, all_.jacobian, all_.equations);
  const auto is_given = [&](const Candidate& one) {
    return std::ranges::any_of(given, [&](const Hypothesis& h) { return h.candidate.is_of_family(one); });
  };
  std::map<std::string, Least> limits;
  for (std::size_t c = 0; c < tests.size(); ++c) {
    if (!tests[c] || all[c].is_shape() || is_given(all[c])) continue;
    const Least own{.limit = limit_of(all[c], *tests[c], settings_.selection, all_.equations.beams),
                    .candidate = c};
    const auto [known, is_new] = limits.try_emplace(all[c].cause_name(), own);
    if (own.limit < known->second.limit) known->second = own;
  }
  std::vector<Limit> hidden;
  for (const auto& [name, least] : limits) {
    if (least.limit < kMuch * settings_.refinement.surfels.noise) continue;
    hidden.push_back({.name = name,
                      .size = least.limit,
                      .combination = known_instead(least.candidate, taken, all_.jacobian, all_.equations)});
  }
  return hidden;
}

}  // namespace crisp::diagnose
