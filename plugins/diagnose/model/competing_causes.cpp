// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/competing_causes.hpp"

#include <algorithm>
#include <iterator>

#include "plugins/diagnose/model/conditional_score_test.hpp"

namespace crisp::diagnose {
namespace {

template <class Predicate>
std::vector<std::size_t> members_where(const std::vector<std::size_t>& taken, Predicate is_one) {
  std::vector<std::size_t> some;
  std::ranges::copy_if(taken, std::back_inserter(some), is_one);
  return some;
}

}  // namespace

std::vector<std::size_t> without(std::vector<std::size_t> taken, std::size_t one) {
  std::erase(taken, one);
  return taken;
}

SelectedCandidate Competition::with_competing_families(const std::vector<std::size_t>& taken,
                                                       std::size_t one) const {
  SelectedCandidate choice = with_competitors(taken, one);
  const auto& candidates = jacobian_.candidates();
  if (!candidates[one].is_cause()) return choice;
  const double sharing = candidates[one].in_model ? choice.test.design_effect() : 1;
  const auto own =
      members_where(taken, [&](std::size_t t) { return candidates[t].is_of_family(candidates[one]); });
  const auto alike = members_where(taken, [&](std::size_t t) {
    return candidates[t].laser() && candidates[t].family == candidates[one].family;
  });
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (!is_general_member(c) || !could_replace(c, one) || is_taken(c, taken)) continue;
    add_competitor(choice, c, remaining(own, with_levels({c}), taken) / sharing);
    if (could_be_level(choice, c, taken)) add_competitor(choice, c, 0);
    if (alike.size() > own.size())
      add_competitor(choice, c, remaining(alike, with_levels(in_each_laser(c, alike)), taken) / sharing);
  }
  std::ranges::sort(choice.alternatives, {}, &CompetingCandidate::behind);
  return choice;
}

SelectedCandidate Competition::with_competitors(const std::vector<std::size_t>& taken,
                                                std::size_t one) const {
  const auto tests = score_tests_given(without(taken, one), jacobian_, equations_);
  const auto& candidates = jacobian_.candidates();
  SelectedCandidate choice{.candidate = one, .test = *tests[one], .alternatives = {}};
  // The design effect reduces the evidence of correlated beams for all candidates alike.
  const double sharing = candidates[one].in_model ? choice.test.design_effect() : 1;
  for (std::size_t c = 0; c < tests.size(); ++c) {
    if (!tests[c] || candidates[c].is_of_family(candidates[one]) || !candidates[c].is_cause()) continue;
    add_competitor(choice, c, (choice.test.bic - tests[c]->bic) / sharing);
  }
  std::ranges::sort(choice.alternatives, {}, &CompetingCandidate::behind);
  return choice;
}

std::vector<std::vector<std::size_t>> Competition::replacements_of(std::size_t one) const {
  const auto& candidates = jacobian_.candidates();
  std::vector<std::vector<std::size_t>> all;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (!candidates[c].is_cause() || candidates[c].is_fine || !could_replace(c, one)) continue;
    all.push_back(with_levels({c}));
    std::erase_if(all.back(),
                  [&](std::size_t other) { return candidates[other].is_of_family(candidates[one]); });
  }
  return all;
}

double Competition::remaining(const std::vector<std::size_t>& some, const std::vector<std::size_t>& instead,
                              const std::vector<std::size_t>& taken) const {
  const auto is_in = [](const std::vector<std::size_t>& all, std::size_t one) {
    return std::ranges::find(all, one) != all.end();
  };
  auto with = members_where(taken, [&](std::size_t t) { return !is_in(some, t); });
  for (const std::size_t one : instead) {
    if (!is_in(with, one) && !is_in(some, one)) with.push_back(one);
  }
  return joint_score_test_given(with, some, jacobian_, equations_).bic;
}
std::vector<std::size_t> Competition::with_levels(std::vector<std::size_t> some) const {
  const auto& candidates = jacobian_.candidates();
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const bool is_level =
        std::ranges::any_of(some, [&](std::size_t s) { return candidates[c].is_level_of(candidates[s]); });
    if (is_level) some.push_back(c);
  }
  return some;
}
std::vector<std::size_t> Competition::in_each_laser(std::size_t candidate,
                                                    const std::vector<std::size_t>& some) const {
  const auto& candidates = jacobian_.candidates();
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const bool is_same_term = candidates[c].term.term == candidates[candidate].term.term;
    const bool is_there =
        std::ranges::any_of(some, [&](std::size_t s) { return candidates[s].owner == candidates[c].owner; });
    if (is_same_term && is_there) all.push_back(c);
  }
  return all;
}
bool Competition::is_general_member(std::size_t candidate) const {
  const Candidate& one = jacobian_.candidates()[candidate];
  return one.is_cause() && one.is_shape() && !one.is_fine;
}

bool Competition::could_be_level(const SelectedCandidate& choice, std::size_t cause,
                                 const std::vector<std::size_t>& taken) const {
  const auto& candidates = jacobian_.candidates();
  if (!candidates[choice.candidate].is_level_of(candidates[cause])) return false;
  const ScoreTest curve = joint_score_test_given(taken, {cause}, jacobian_, equations_);
  return curve.ranges + kCurveErrors * curve.ranges_error > kPartOfLevel * choice.test.ranges;
}

bool Competition::could_replace(std::size_t candidate, std::size_t one) const {
  const Candidate& other = jacobian_.candidates()[candidate];
  const Candidate& selected = jacobian_.candidates()[one];
  return other.laser() == selected.laser() && !other.is_of_family(selected);
}

bool Competition::is_taken(std::size_t candidate, const std::vector<std::size_t>& taken) const {
  const auto& candidates = jacobian_.candidates();
  return std::ranges::any_of(
      taken, [&](std::size_t t) { return candidates[t].is_of_family(candidates[candidate]); });
}

void Competition::add_competitor(SelectedCandidate& choice, std::size_t candidate, double behind) const {
  const auto& candidates = jacobian_.candidates();
  const auto known = std::ranges::find_if(choice.alternatives, [&](const CompetingCandidate& a) {
    return candidates[a.candidate].is_of_family(candidates[candidate]);
  });
  if (known == choice.alternatives.end())
    choice.alternatives.push_back({.candidate = candidate, .behind = behind});
  else if (behind < known->behind)
    *known = {.candidate = candidate, .behind = behind};
}

}  // namespace crisp::diagnose
