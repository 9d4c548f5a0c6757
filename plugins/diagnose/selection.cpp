// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include "pipeline/estimate/observability.hpp"

namespace crisp {
namespace {

std::vector<std::size_t> without(std::vector<std::size_t> taken, std::size_t one) {
  std::erase(taken, one);
  return taken;
}

/// The parameters that are estimated beside whatever is looked at: the base's, and those of what was taken.
std::vector<std::size_t> estimated_with(const std::vector<std::size_t>& taken, const Dictionary& dictionary) {
  std::vector<std::size_t> parameters(dictionary.base());
  std::iota(parameters.begin(), parameters.end(), std::size_t{0});
  for (const std::size_t t : taken) {
    parameters.insert(parameters.end(), dictionary.of(t).begin(), dictionary.of(t).end());
  }
  return parameters;
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
    const bool of_plate = candidate.name == candidate.term.term;
    if (of_plate || !candidate.is_cause()) continue;
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

/// The equations where the base and what was taken are estimated, too.
NormalEquations beside_base(const std::vector<std::size_t>& taken, const Dictionary& dictionary,
                            const NormalEquations& equations) {
  std::vector<std::size_t> all(dictionary.parameters());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return equations.reduced(all, estimated_with(taken, dictionary));
}

/// @param left  the equations beside the base and what was taken
std::vector<std::optional<Look>> looks_in(const NormalEquations& left, const std::vector<std::size_t>& taken,
                                          const Dictionary& dictionary) {
  const auto& candidates = dictionary.candidates();
  std::vector<std::optional<Look>> looks(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const bool there =
        std::ranges::any_of(taken, [&](std::size_t t) { return candidates[t].is_form_of(candidates[c]); });
    if (there) continue;
    Look look = look_at(left, dictionary.of(c));
    // A form that was chosen among several is a parameter, too.
    if (candidates[c].forms > 1) look.bic -= std::log(static_cast<double>(left.beams));
    looks[c] = std::move(look);
  }
  return looks;
}

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

  bool is_needed(std::size_t candidate, const Look& look) const {
    const Candidate& which = dictionary_.candidates()[candidate];
    return !refused_.contains(which.name) && look.bic > settings_.bic && look.visible > settings_.visible &&
           (!which.in_model || look.p_value * static_cast<double>(looks_) < settings_.p_value);
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
  /// @param left  the equations beside the base and what was taken
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
      std::vector<std::size_t> parameters;
      double forms = 0;
      for (const std::size_t m : members) {
        parameters.insert(parameters.end(), dictionary_.of(m).begin(), dictionary_.of(m).end());
        forms += candidates[m].forms > 1 ? 1 : 0;
      }
      Together one{.members = members, .look = look_at(left, parameters)};
      one.look.bic -= forms * std::log(static_cast<double>(equations_.beams));
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
    const auto looks = looks_in(left, taken, dictionary_);
    const auto one = best(looks, rough);
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
  const Dictionary& dictionary_;
  const NormalEquations& equations_;
  const SelectionSettings& settings_;
  const std::set<std::string>& refused_;
  std::size_t looks_ = 1;
  std::vector<std::vector<std::size_t>> of_all_;
};

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

std::vector<Choice> choose(const Dictionary& dictionary, const NormalEquations& equations,
                           const SelectionSettings& settings, const std::set<std::string>& refused,
                           std::size_t looks) {
  const Chooser chooser(dictionary, equations, settings, refused, looks);
  std::vector<std::size_t> taken;
  std::set<std::vector<std::size_t>> seen;
  double rough = 0;
  while (taken.size() < settings.most && seen.insert(taken).second) {
    const auto next = chooser.next(taken, rough);
    if (!next) break;
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
