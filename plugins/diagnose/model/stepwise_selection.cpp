// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/stepwise_selection.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "plugins/diagnose/model/conditional_score_test.hpp"

namespace crisp::diagnose {
namespace {

/// Groups causes that lasers of one make may share: the same cause of each laser, in one form unless the
/// model has another.
std::vector<std::vector<std::size_t>> causes_of_all_lasers(const std::vector<Candidate>& candidates) {
  using OfLaser = std::map<std::size_t, std::size_t>;
  struct OfTerm {
    OfLaser in_model;
    std::map<double, OfLaser> in_form;
  };
  std::map<std::string, OfTerm> terms;
  std::set<std::size_t> lasers;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Candidate& candidate = candidates[c];
    if (!candidate.laser() || !candidate.is_cause() || candidate.is_fine) continue;
    lasers.insert(candidate.owner);
    OfTerm& term = terms[candidate.term.term];
    (candidate.in_model ? term.in_model : term.in_form[candidate.form])[candidate.owner] = c;
  }
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [name, term] : terms) {
    if (term.in_form.empty()) term.in_form[0] = {};
    for (auto& [form, members] : term.in_form) {
      members.insert(term.in_model.begin(), term.in_model.end());
      if (members.size() < 2 || members.size() < lasers.size()) continue;
      auto& group = groups.emplace_back();
      for (const auto& [laser, candidate] : members) group.push_back(candidate);
    }
  }
  return groups;
}

/// Candidates that are selected jointly, with their joint test.
struct Together {
  std::vector<std::size_t> members;
  ScoreTest test;
};

/// Stepwise selection: conditional score tests of the candidates given a selected set.
class Chooser {
  static constexpr double kSmall = 0.05;  ///< share of `rough` below which a gain waits

 public:
  Chooser(const CandidateJacobian& jacobian, const quality::NormalEquations& equations,
          const SelectionSettings& settings, const std::set<std::string>& rejected, std::size_t tests)
      : jacobian_(jacobian),
        equations_(equations),
        competition_(jacobian, equations),
        settings_(settings),
        rejected_(rejected) {
    std::set<std::string> names;
    for (const auto& candidate : jacobian.candidates()) names.insert(candidate.name);
    tests_ = std::max(tests, names.size());
    of_all_ = causes_of_all_lasers(jacobian.candidates());
  }

  std::vector<std::optional<ScoreTest>> given(const std::vector<std::size_t>& taken) const {
    return score_tests_given(taken, jacobian_, equations_);
  }

  /// Whether the candidate was rejected, or is not significant although its p-value is valid: it is in the
  /// model, or too small to make the blocks scatter by itself. Shapes with about as many parameters as there
  /// are blocks are exempt: cross-validation decides on them.
  bool is_rejected(std::size_t candidate, const ScoreTest& test) const {
    const Candidate& which = jacobian_.candidates()[candidate];
    const bool is_exempt = which.is_fine || (which.is_shape() && !test.is_testable);
    const bool has_valid_p = (which.in_model || test.gain < settings_.untested) && !is_exempt;
    return rejected_.contains(which.name) ||
           (has_valid_p && !(test.p_value * static_cast<double>(tests_) < settings_.p_value));
  }

  bool is_needed(std::size_t candidate, const ScoreTest& test) const {
    return !is_rejected(candidate, test) && test.bic > settings_.bic && test.visible > settings_.visible;
  }

  /// Whether a rejected candidate would explain all of this one's gain. Correlated or unmodeled errors
  /// resemble many causes a little, and each further candidate would be another chance of a false positive.
  ///
  /// @param tests  given the selected candidates
  bool is_part_of_rejected(std::size_t one, const std::vector<std::optional<ScoreTest>>& tests,
                           const std::vector<std::size_t>& taken) const {
    if (jacobian_.candidates()[one].in_model) return false;
    return std::ranges::any_of(rejected_like(*tests[one], tests), [&](std::size_t other) {
      std::vector<std::size_t> with = taken;
      with.push_back(other);
      const auto left = given(with)[one];
      return left && left->bic < settings_.bic;
    });
  }

  /// The needed candidate with the largest decrease of the BIC. A cause's own formula takes precedence over
  /// its family's general shape, and that over a shape without a cause, unless the latter gains much more: an
  /// actual cause gains about as much as its description.
  ///
  /// @param rough  BIC gained by shapes, and by candidates whose forms are still on the coarse grid, that the
  ///               model does not have yet. A much smaller gain may be their approximation error, and waits
  ///               until they are refined
  std::optional<std::size_t> best(const std::vector<std::optional<ScoreTest>>& tests, double rough) const {
    std::array<std::optional<std::size_t>, 3> best;  // by rank
    for (std::size_t c = 0; c < tests.size(); ++c) {
      if (!tests[c] || !is_needed(c, *tests[c]) || tests[c]->bic < kSmall * rough) continue;
      const Candidate& candidate = jacobian_.candidates()[c];
      auto& of_rank = best[candidate.is_cause() ? (candidate.is_shape() ? 1 : 0) : 2];
      if (!of_rank || tests[c]->bic > tests[*of_rank]->bic) of_rank = c;
    }
    constexpr double kMuchMore = 1.4;  // about twice for two ranks
    std::optional<std::size_t> chosen;
    for (const auto& of_rank : best) {
      const bool is_better = of_rank && (!chosen || tests[*of_rank]->bic >= kMuchMore * tests[*chosen]->bic);
      if (is_better) chosen = of_rank;
    }
    return chosen;
  }

  /// Whether each of some candidates is determined given the others and those taken. The scales of all lasers
  /// are not, for example, where the scene's may be another: with them nothing else would be.
  bool is_determined(const std::vector<std::size_t>& members, const std::vector<std::size_t>& taken) const {
    return std::ranges::all_of(members, [&](std::size_t one) {
      std::vector<std::size_t> others = without(members, one);
      others.insert(others.end(), taken.begin(), taken.end());
      const auto test = given(others)[one];
      return test && test->visible > 0;
    });
  }

  /// The best cause that all lasers share, if it is needed and no part of it is selected.
  ///
  /// @param left  normal equations after eliminate_base()
  std::optional<Together> best_of_all(const std::vector<std::size_t>& taken,
                                      const quality::NormalEquations& left, double rough) const {
    const auto& candidates = jacobian_.candidates();
    std::optional<Together> best;
    for (const auto& members : of_all_) {
      const bool is_there = std::ranges::any_of(taken, [&](std::size_t t) {
        return std::ranges::any_of(members,
                                   [&](std::size_t m) { return candidates[m].is_form_of(candidates[t]); });
      });
      if (is_there) continue;
      Together one{.members = members, .test = joint_score_test(members, jacobian_, left)};
      const bool is_needed_everywhere =
          std::ranges::all_of(members, [&](std::size_t m) { return is_needed(m, one.test); });
      const bool is_large = one.test.bic >= kSmall * rough;
      const bool is_better = is_needed_everywhere && is_large && (!best || one.test.bic > best->test.bic);
      if (is_better && is_determined(members, taken)) best = std::move(one);
    }
    return best;
  }

  /// Next selection: a cause shared by all lasers only if it gains much more than any single candidate.
  std::optional<Together> next(const std::vector<std::size_t>& taken, double rough) const {
    constexpr double kMore = 1.5;
    const quality::NormalEquations left = eliminate_base(taken, jacobian_, equations_);
    auto tests = score_tests(left, taken, jacobian_);
    auto one = best(tests, rough);
    while (one && is_part_of_rejected(*one, tests, taken)) {
      tests[*one].reset();
      one = best(tests, rough);
    }
    auto all = best_of_all(taken, left, rough);
    if (all && (!one || all->test.bic > kMore * tests[*one]->bic)) return all;
    if (!one) return std::nullopt;
    return Together{.members = {*one}, .test = *tests[*one]};
  }

  /// Backward elimination of candidates that are not needed given the rest.
  void eliminate_needless(std::vector<std::size_t>& taken) const {
    while (true) {
      std::optional<std::size_t> least;
      double least_bic = 0;
      for (const std::size_t t : taken) {
        const ScoreTest test = *given(without(taken, t))[t];
        if (!is_needed(t, test) && (!least || test.bic < least_bic)) {
          least = t;
          least_bic = test.bic;
        }
      }
      if (!least) return;
      std::erase(taken, *least);
    }
  }

  /// Tries to replace a selected cause by a competitor that is not resolvable from it, such that other
  /// candidates become needless. Keeps the smaller set if its BIC is as good.
  ///
  /// @return  whether the set changed
  bool replace_by_fewer(std::vector<std::size_t>& taken) const {
    if (taken.size() < 2) return false;
    const double own = bic_of(taken);
    for (const std::size_t one : taken) {
      if (!jacobian_.candidates()[one].is_cause()) continue;
      for (const CompetingCandidate& other : competition_.with_competitors(taken, one).alternatives) {
        if (other.behind > settings_.odds) break;  // sorted, the nearest first
        std::vector<std::size_t> instead = taken;
        std::ranges::replace(instead, one, other.candidate);
        eliminate_needless(instead);
        if (instead.empty() || instead.size() >= taken.size() || bic_of(instead) < own) continue;
        taken = std::move(instead);
        return true;
      }
    }
    return false;
  }

  /// Replaces a cause with a form by a description of no more parameters if that fits significantly better,
  /// then eliminates needless candidates. A flexible form may come close to an effect that has another cause.
  ///
  /// @return  whether the set changed
  bool replace_by_description(std::vector<std::size_t>& taken) const {
    const auto& candidates = jacobian_.candidates();
    for (const std::size_t one : taken) {
      if (!candidates[one].in_model || !candidates[one].is_cause() || candidates[one].forms < 2) continue;
      const auto tests = given(without(taken, one));
      for (std::size_t c = 0; c < tests.size(); ++c) {
        if (!candidates[c].is_shape() || !tests[c] || !is_needed(c, *tests[c])) continue;
        const bool is_simpler =
            tests[c]->value.size() <= tests[one]->value.size() + 1;  // the form counts as a parameter
        const double ahead = (tests[c]->bic - tests[one]->bic) / tests[one]->design_effect();
        if (!is_simpler || ahead < settings_.odds) continue;
        std::ranges::replace(taken, one, c);
        eliminate_needless(taken);
        return true;
      }
    }
    return false;
  }

  SelectedCandidate with_competing_families(const std::vector<std::size_t>& taken, std::size_t one) const {
    return competition_.with_competing_families(taken, one);
  }

 private:
  /// The few best rejected candidates that gain no less than this one; one form of each.
  std::vector<std::size_t> rejected_like(const ScoreTest& own,
                                         const std::vector<std::optional<ScoreTest>>& tests) const {
    constexpr std::size_t kFew = 3;
    const double least = std::max(settings_.bic, own.bic - settings_.odds);
    std::map<std::string, std::size_t> best;
    for (std::size_t c = 0; c < tests.size(); ++c) {
      if (!tests[c] || tests[c]->bic < least || !is_rejected(c, *tests[c])) continue;
      const auto [known, is_new] = best.try_emplace(jacobian_.candidates()[c].name, c);
      if (!is_new && tests[c]->bic > tests[known->second]->bic) known->second = c;
    }
    std::vector<std::size_t> some;
    for (const auto& [name, candidate] : best) some.push_back(candidate);
    std::ranges::sort(some, std::greater{}, [&](std::size_t c) { return tests[c]->bic; });
    some.resize(std::min(some.size(), kFew));
    return some;
  }

  /// BIC of a set of candidates given the base alone.
  double bic_of(const std::vector<std::size_t>& taken) const {
    return joint_score_test(taken, jacobian_, eliminate_base({}, jacobian_, equations_)).bic;
  }

  const CandidateJacobian& jacobian_;
  const quality::NormalEquations& equations_;
  Competition competition_;
  const SelectionSettings& settings_;
  const std::set<std::string>& rejected_;
  std::size_t tests_ = 1;
  std::vector<std::vector<std::size_t>> of_all_;
};

}  // namespace

std::vector<SelectedCandidate> choose(const CandidateJacobian& jacobian,
                                      const quality::NormalEquations& equations,
                                      const SelectionSettings& settings,
                                      const std::set<std::string>& rejected, std::size_t tests) {
  const Chooser chooser(jacobian, equations, settings, rejected, tests);
  std::vector<std::size_t> taken;
  std::set<std::vector<std::size_t>> seen;
  double rough = 0;
  while (taken.size() < settings.most && seen.insert(taken).second) {
    const auto next = chooser.next(taken, rough);
    if (!next) {
      if (rough > 0 || !(chooser.replace_by_fewer(taken) || chooser.replace_by_description(taken))) break;
      continue;
    }
    for (const std::size_t member : next->members) {
      const Candidate& one = jacobian.candidates()[member];
      const bool is_rough = !one.in_model && (one.forms > 1 || one.is_shape());
      if (is_rough) rough = std::max(rough, next->test.bic);
      taken.push_back(member);
    }
    chooser.eliminate_needless(taken);
  }
  std::vector<SelectedCandidate> choices;
  for (const std::size_t t : taken) choices.push_back(chooser.with_competing_families(taken, t));
  return choices;
}

}  // namespace crisp::diagnose
