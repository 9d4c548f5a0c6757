// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "pipeline/estimate/wanted_terms.hpp"
#include "plugins/diagnose/beside.hpp"

namespace crisp {
namespace {

/// λ, τ, α, η as far as the refinement left them free.
std::vector<std::size_t> base_of(const Refinement& refinement) {
  std::vector<std::size_t> base;
  for (const std::size_t parameter : refinement.outcome.free) {
    if (!declared(refinement.outcome.model, parameter)) base.push_back(parameter);
  }
  return base;
}

std::vector<Departure::Rival> rivals(const Choice& choice, const Dictionary& dictionary) {
  constexpr std::size_t kMost = 5;
  std::vector<Departure::Rival> result;
  for (const Alternative& other : choice.alternatives) {
    if (result.size() == kMost) break;
    const Candidate& candidate = dictionary.candidates()[other.candidate];
    result.push_back({.name = candidate.name,
                      .behind = other.behind,
                      .term = candidate.term.term,
                      .owner = candidate.owner});
  }
  return result;
}

/// [m] By how much a candidate can change ranges (RMS) without being taken: because it is not significant, or
/// because the other parameters leave too little of it to be seen.
double limit_of(const Candidate& candidate, const Look& look, const SelectionSettings& settings,
                std::size_t beams) {
  const auto parameters = static_cast<double>(look.value.size()) + (candidate.forms > 1 ? 1 : 0);
  const double significant =
      std::sqrt(settings.bic + parameters * std::log(static_cast<double>(beams))) * look.ranges_error;
  return look.visible > 0 ? std::max(significant, look.ranges * settings.visible / look.visible)
                          : std::numeric_limits<double>::infinity();
}

std::vector<std::size_t> in_model(const std::vector<Candidate>& candidates) {
  std::vector<std::size_t> some;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (candidates[c].in_model) some.push_back(c);
  }
  return some;
}

/// [m RMS] By how much the candidate's laser departs over its covariate; 0: not for sure.
double departs_over(const Candidate& one, const SideBySide& left) {
  const auto profile = std::ranges::find_if(left.profiles, [&](const Profile& other) {
    return other.laser == one.laser() && other.covariate == one.covariate && other.departs();
  });
  return profile != left.profiles.end() ? profile->rms : 0;
}

std::vector<Candidate> possible(const TermRegistry& terms, const SensorModel& model, const Coverage& coverage,
                                const std::set<std::string>& excluded, const SideBySide& left) {
  auto all = candidates(terms, model.calibration(), coverage);
  std::map<std::size_t, double> most;  // by owner, over what a fine shape could describe
  for (const Candidate& one : all) {
    if (one.is_fine) most[one.owner] = std::max(most[one.owner], departs_over(one, left));
  }
  std::erase_if(all, [&](const Candidate& one) {
    const double departs = departs_over(one, left);
    const bool is_asked_for = departs > 0 && departs == most[one.owner];
    return excluded.contains(one.name) || (one.is_fine && !one.in_model && !is_asked_for);
  });
  return all;
}

}  // namespace

Survey::Survey(const Evidence& evidence, const Refinement& at, const TermRegistry& terms,
               const DiagnosisSettings& settings, const SideBySide& left)
    : evidence_(evidence),
      terms_(terms),
      settings_(settings),
      model_(at.outcome.model),
      base_(base_of(at)),
      all_(view(possible(terms, model_, evidence.coverage(), settings.excluded, left), settings.beams)) {
  std::set<std::string> names;
  for (const Candidate& candidate : all_.dictionary.candidates()) names.insert(candidate.name);
  looks_ = names.size();
}

Survey::View Survey::view(std::vector<Candidate> candidates, std::size_t beams) const {
  Dictionary dictionary(model_, base_, std::move(candidates), terms_);
  NormalEquations equations = from_neutral(dictionary, evidence_.equations(dictionary, beams));
  return {.dictionary = std::move(dictionary), .equations = std::move(equations)};
}

std::vector<Departure> Survey::needs_in(const View& view, const SelectionSettings& selection,
                                        const std::set<std::string>& refused) const {
  std::vector<Departure> needs;
  for (const Choice& choice : choose(view.dictionary, view.equations, selection, refused, looks_)) {
    needs.push_back({.candidate = valued(view.dictionary.candidates()[choice.candidate], choice.look, terms_),
                     .look = choice.look,
                     .rivals = rivals(choice, view.dictionary),
                     .gains = {}});
  }
  return needs;
}

std::vector<Departure> Survey::needs(const std::set<std::string>& refused) const {
  return needs_in(all_, settings_.selection, refused);
}

/// What the model has, and what may yet be there, beside all of that or in the place of a part of it: what
/// more beams will show shows in fewer by more than chance does.
std::vector<Candidate> Survey::promising() const {
  const auto& all = all_.dictionary.candidates();
  const auto taken = in_model(all);
  std::set<std::size_t> some(taken.begin(), taken.end());
  const auto add_those_seen_beside = [&](const std::vector<std::size_t>& others) {
    const auto looks = looks_beside(others, all_.dictionary, all_.equations);
    for (std::size_t c = 0; c < all.size(); ++c) {
      if (looks[c] && looks[c]->gain > static_cast<double>(looks[c]->value.size())) some.insert(c);
    }
  };
  add_those_seen_beside(taken);
  for (const std::size_t one : taken) {
    auto others = taken;
    std::erase(others, one);
    add_those_seen_beside(others);
  }
  std::vector<Candidate> candidates;
  for (const std::size_t c : some) candidates.push_back(all[c]);
  return candidates;
}

std::vector<Departure> Survey::closer_needs(const std::set<std::string>& refused) const {
  SelectionSettings selection = settings_.selection;
  selection.visible = settings_.faint;
  auto needs = needs_in(view(promising(), settings_.closer), selection, refused);
  std::erase_if(needs, [](const Departure& departure) {
    return !departure.candidate.is_cause() && !departure.candidate.in_model;
  });
  return needs;
}

std::vector<Limit> Survey::unobservable(const std::vector<Departure>& beside) const {
  constexpr double kMuch = 0.25;
  struct Least {
    double limit = 0;
    std::size_t candidate = 0;
  };
  const auto& all = all_.dictionary.candidates();
  std::vector<std::size_t> taken;
  for (std::size_t c = 0; c < all.size(); ++c) {
    const bool is_taken = std::ranges::any_of(beside, [&](const Departure& departure) {
      return departure.candidate.is_form_of(all[c]) && departure.candidate.form == all[c].form;
    });
    if (is_taken) taken.push_back(c);
  }
  const auto looks = looks_beside(taken, all_.dictionary, all_.equations);
  std::map<std::string, Least> limits;
  for (std::size_t c = 0; c < looks.size(); ++c) {
    if (!looks[c] || !all[c].is_cause()) continue;
    const Least own{.limit = limit_of(all[c], *looks[c], settings_.selection, all_.equations.beams),
                    .candidate = c};
    const auto [known, is_new] = limits.try_emplace(all[c].name, own);
    if (own.limit < known->second.limit) known->second = own;
  }
  std::vector<Limit> hidden;
  for (const auto& [name, least] : limits) {
    if (least.limit < kMuch * settings_.refinement.surfels.noise) continue;
    hidden.push_back({.name = name,
                      .size = least.limit,
                      .combination = known_instead(least.candidate, taken, all_.dictionary, all_.equations)});
  }
  return hidden;
}

}  // namespace crisp
