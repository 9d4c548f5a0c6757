// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/selection.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "plugins/diagnose/beside.hpp"

namespace crisp {
namespace {

std::vector<std::size_t> without(std::vector<std::size_t> taken, std::size_t one) {
  std::erase(taken, one);
  return taken;
}

/// What may befall all lasers alike, since they are of one make: the same cause of each of them, in one form
/// but where the model has another.
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
    if (!candidate.laser() || !candidate.is_cause()) continue;
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

/// Candidates that are taken at once, and what the data say of them.
struct Together {
  std::vector<std::size_t> members;
  Look look;
};

/// A set of candidates, and what the data say of each other one beside it.
class Chooser {
 public:
  Chooser(const Dictionary& dictionary, const NormalEquations& equations, const SelectionSettings& settings,
          const std::set<std::string>& refused, std::size_t looks)
      : dictionary_(dictionary), equations_(equations), settings_(settings), refused_(refused) {
    std::set<std::string> names;
    for (const auto& candidate : dictionary.candidates()) names.insert(candidate.name);
    looks_ = std::max(looks, names.size());
    of_all_ = causes_of_all_lasers(dictionary.candidates());
  }

  std::vector<std::optional<Look>> beside(const std::vector<std::size_t>& taken) const {
    return looks_beside(taken, dictionary_, equations_);
  }

  /// Whether it has been in the model and the data did not bear it out, or do not now. Blocks say nothing of
  /// a fine shape, which has about as many parameters as there are blocks: held-out turns judge it.
  bool is_refused(std::size_t candidate, const Look& look) const {
    const Candidate& which = dictionary_.candidates()[candidate];
    const bool is_asked = which.in_model && !which.is_fine;
    return refused_.contains(which.name) ||
           (is_asked && !(look.p_value * static_cast<double>(looks_) < settings_.p_value));
  }

  bool is_needed(std::size_t candidate, const Look& look) const {
    return !is_refused(candidate, look) && look.bic > settings_.bic && look.visible > settings_.visible;
  }

  /// Whether one that was refused would do as much, and all of it: what beams share by chance, or by what
  /// nothing describes, looks a little like many a cause, and each further one that is tried is a further
  /// chance to be taken.
  ///
  /// @param looks  beside what was taken
  bool is_part_of_refused(std::size_t one, const std::vector<std::optional<Look>>& looks,
                          const std::vector<std::size_t>& taken) const {
    if (dictionary_.candidates()[one].in_model) return false;
    return std::ranges::any_of(refused_like(*looks[one], looks), [&](std::size_t other) {
      std::vector<std::size_t> with = taken;
      with.push_back(other);
      const auto left = beside(with)[one];
      return left && left->bic < settings_.bic;
    });
  }

  /// The best of those that are needed: a cause, unless a mere description says much more. Where a cause is
  /// at work, it does about as well as what describes it by its shape, and other causes do not.
  ///
  /// @param rough  BIC that was gained by forms that are known roughly: what is small beside it may be what
  ///               they leave, and has to wait until they are told more finely
  std::optional<std::size_t> best(const std::vector<std::optional<Look>>& looks, double rough) const {
    constexpr double kSmall = 0.05;
    std::array<std::optional<std::size_t>, 2> best;
    for (std::size_t c = 0; c < looks.size(); ++c) {
      if (!looks[c] || !is_needed(c, *looks[c]) || looks[c]->bic < kSmall * rough) continue;
      auto& of_kind = best[dictionary_.candidates()[c].is_cause() ? 0 : 1];
      if (!of_kind || looks[c]->bic > looks[*of_kind]->bic) of_kind = c;
    }
    constexpr double kMuchMore = 2;
    const bool is_cause = best[0] && (!best[1] || looks[*best[1]]->bic < kMuchMore * looks[*best[0]]->bic);
    return is_cause ? best[0] : best[1];
  }

  /// The best of the causes that befall all lasers, if one is needed and none of it is taken.
  ///
  /// @param left  see beside_base()
  std::optional<Together> best_of_all(const std::vector<std::size_t>& taken,
                                      const NormalEquations& left) const {
    const auto& candidates = dictionary_.candidates();
    std::optional<Together> best;
    for (const auto& members : of_all_) {
      const bool is_there = std::ranges::any_of(taken, [&](std::size_t t) {
        return std::ranges::any_of(members,
                                   [&](std::size_t m) { return candidates[m].is_form_of(candidates[t]); });
      });
      if (is_there) continue;
      Together one{.members = members, .look = look_together(members, dictionary_, left)};
      const bool is_needed_everywhere =
          std::ranges::all_of(members, [&](std::size_t m) { return is_needed(m, one.look); });
      if (is_needed_everywhere && (!best || one.look.bic > best->look.bic)) best = std::move(one);
    }
    return best;
  }

  /// What to take next: a cause that befalls all lasers only if it says much more than anything of one.
  std::optional<Together> next(const std::vector<std::size_t>& taken, double rough) const {
    constexpr double kMore = 1.5;
    const NormalEquations left = beside_base(taken, dictionary_, equations_);
    auto looks = looks_in(left, taken, dictionary_);
    auto one = best(looks, rough);
    while (one && is_part_of_refused(*one, looks, taken)) {
      looks[*one].reset();
      one = best(looks, rough);
    }
    auto all = best_of_all(taken, left);
    if (all && (!one || all->look.bic > kMore * looks[*one]->bic)) return all;
    if (!one) return std::nullopt;
    return Together{.members = {*one}, .look = *looks[*one]};
  }

  /// Leaves out, one after another, what is not needed beside the rest.
  void leave_out_needless(std::vector<std::size_t>& taken) const {
    while (true) {
      std::optional<std::size_t> least;
      double least_bic = 0;
      for (const std::size_t t : taken) {
        const Look look = *beside(without(taken, t))[t];
        if (!is_needed(t, look) && (!least || look.bic < least_bic)) {
          least = t;
          least_bic = look.bic;
        }
      }
      if (!least) return;
      std::erase(taken, *least);
    }
  }

  /// One that could not be told from what was taken may do without what makes up for the difference: puts it
  /// in, and leaves out what is needless then, where that says as much with fewer.
  ///
  /// @return  whether anything was
  bool replace_by_fewer(std::vector<std::size_t>& taken) const {
    if (taken.size() < 2) return false;
    const double own = bic_of(taken);
    for (const std::size_t one : taken) {
      if (!dictionary_.candidates()[one].is_cause()) continue;
      for (const Alternative& other : described(taken, one).alternatives) {
        if (other.behind > settings_.odds) break;  // the nearest come first
        std::vector<std::size_t> instead = taken;
        std::ranges::replace(instead, one, other.candidate);
        leave_out_needless(instead);
        if (instead.empty() || instead.size() >= taken.size() || bic_of(instead) < own) continue;
        taken = std::move(instead);
        return true;
      }
    }
    return false;
  }

  /// A cause of whatever form comes near much that has no cause. Puts a mere description of no more
  /// parameters in the place of such a one where that says more, for sure, and leaves out what is needless
  /// then.
  ///
  /// @return  whether anything was
  bool replace_by_description(std::vector<std::size_t>& taken) const {
    const auto& candidates = dictionary_.candidates();
    for (const std::size_t one : taken) {
      if (!candidates[one].in_model || !candidates[one].is_cause() || candidates[one].forms < 2) continue;
      const auto looks = beside(without(taken, one));
      for (std::size_t c = 0; c < looks.size(); ++c) {
        if (candidates[c].is_cause() || !looks[c] || !is_needed(c, *looks[c])) continue;
        const bool is_simpler =
            looks[c]->value.size() <= looks[one]->value.size() + 1;  // that has a form, too
        const double ahead = (looks[c]->bic - looks[one]->bic) / looks[one]->sharing();
        if (!is_simpler || ahead < settings_.odds) continue;
        std::ranges::replace(taken, one, c);
        leave_out_needless(taken);
        return true;
      }
    }
    return false;
  }

  Choice described(const std::vector<std::size_t>& taken, std::size_t one) const {
    const auto looks = beside(without(taken, one));
    const auto& candidates = dictionary_.candidates();
    Choice choice{.candidate = one, .look = *looks[one], .alternatives = {}};
    // Beams that share an error count for less, for one candidate as for another.
    const double sharing = candidates[one].in_model ? choice.look.sharing() : 1;
    for (std::size_t c = 0; c < looks.size(); ++c) {
      if (!looks[c] || candidates[c].is_form_of(candidates[one]) || !candidates[c].is_cause()) continue;
      const double behind = (choice.look.bic - looks[c]->bic) / sharing;
      const auto other = std::ranges::find_if(choice.alternatives, [&](const Alternative& a) {
        return candidates[a.candidate].is_form_of(candidates[c]);
      });
      if (other == choice.alternatives.end()) {
        choice.alternatives.push_back({.candidate = c, .behind = behind});
      } else if (behind < other->behind) {
        *other = {.candidate = c, .behind = behind};
      }
    }
    std::ranges::sort(choice.alternatives, {}, &Alternative::behind);
    return choice;
  }

 private:
  /// Of those that were refused and do no less, the few that do the most; one form of each.
  std::vector<std::size_t> refused_like(const Look& own,
                                        const std::vector<std::optional<Look>>& looks) const {
    constexpr std::size_t kFew = 3;
    const double least = std::max(settings_.bic, own.bic - settings_.odds);
    std::map<std::string, std::size_t> best;
    for (std::size_t c = 0; c < looks.size(); ++c) {
      if (!looks[c] || looks[c]->bic < least || !is_refused(c, *looks[c])) continue;
      const auto [known, is_new] = best.try_emplace(dictionary_.candidates()[c].name, c);
      if (!is_new && looks[c]->bic > looks[known->second]->bic) known->second = c;
    }
    std::vector<std::size_t> some;
    for (const auto& [name, candidate] : best) some.push_back(candidate);
    std::ranges::sort(some, std::greater{}, [&](std::size_t c) { return looks[c]->bic; });
    some.resize(std::min(some.size(), kFew));
    return some;
  }

  /// Of all of them together, beside the base alone.
  double bic_of(const std::vector<std::size_t>& taken) const {
    return look_together(taken, dictionary_, beside_base({}, dictionary_, equations_)).bic;
  }

  const Dictionary& dictionary_;
  const NormalEquations& equations_;
  const SelectionSettings& settings_;
  const std::set<std::string>& refused_;
  std::size_t looks_ = 1;
  std::vector<std::vector<std::size_t>> of_all_;
};

}  // namespace

std::vector<Choice> choose(const Dictionary& dictionary, const NormalEquations& equations,
                           const SelectionSettings& settings, const std::set<std::string>& refused,
                           std::size_t looks) {
  const Chooser chooser(dictionary, equations, settings, refused, looks);
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
      const Candidate& one = dictionary.candidates()[member];
      if (!one.in_model && one.forms > 1) rough = std::max(rough, next->look.bic);
      taken.push_back(member);
    }
    chooser.leave_out_needless(taken);
  }
  std::vector<Choice> choices;
  for (const std::size_t t : taken) choices.push_back(chooser.described(taken, t));
  return choices;
}

}  // namespace crisp
