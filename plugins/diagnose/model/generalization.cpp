// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/generalization.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crisp::diagnose {
namespace {

/// Tests whether the held-out likelihood rises: for a name by its whole confidence interval, since beams are
/// less independent than the training half's significance has them; for a description by itself.
AcceptanceTest cross_validation_of(const std::vector<Gain>& gains, bool is_name) {
  const auto likelihood = std::ranges::find(gains, CrossValidator::kLikelihood, &Gain::metric);
  if (likelihood == gains.end()) return {.name = "cross-validation", .threshold = 0, .passed = false};
  const double rise = likelihood->after - likelihood->before;
  const double least = is_name ? likelihood->ci95[0] : rise;
  return {.name = is_name ? "cross-validation, least rise [nat a measurement]"
                          : "cross-validation [nat a measurement]",
          .statistic = least,
          .threshold = 0,
          .passed = least > 0};
}

/// Set of accepted hypotheses, extended one test at a time.
class ForwardSelection {
 public:
  ForwardSelection(CrossValidator::Score plain, const Calibration& found, const HeldOutScore& held_out,
                   const TermRegistry& terms)
      : found_(found), held_out_(held_out), terms_(terms), score_(std::move(plain)) {}

  /// Tests whether some hypotheses jointly raise the held-out likelihood, and accepts them if so.
  bool accepts(const std::vector<Hypothesis*>& some) {
    auto tried = accepted_;
    for (const Hypothesis* hypothesis : some) tried.push_back(hypothesis->candidate);
    tried = with_values_of(found_, tried);
    auto score = held_out_(with_terms(found_, tried, terms_));
    const auto gains = CrossValidator::gains(score_, score);
    const bool is_name =
        std::ranges::any_of(some, [](const Hypothesis* one) { return one->candidate.is_cause(); });
    const AcceptanceTest test = cross_validation_of(gains, is_name);
    for (Hypothesis* hypothesis : some) {
      if (some.size() > 1 && !test.passed) continue;  // each keeps the gains of its own test
      hypothesis->gains = gains;
      hypothesis->decide(test, {});
    }
    if (!test.passed) return false;
    accepted_ = std::move(tried);
    score_ = std::move(score);
    return true;
  }

 private:
  const Calibration& found_;
  const HeldOutScore& held_out_;
  const TermRegistry& terms_;
  std::vector<Candidate> accepted_;
  CrossValidator::Score score_;
};

}  // namespace

void accept_if_it_generalizes(std::vector<Hypothesis>& hypotheses, const CrossValidator::Score& plain,
                              const Calibration& found, const HeldOutScore& held_out,
                              const TermRegistry& terms) {
  ForwardSelection selection(plain, found, held_out, terms);
  std::vector<Hypothesis*> open;
  for (Hypothesis& hypothesis : hypotheses) {
    if (hypothesis.accepted) open.push_back(&hypothesis);
  }
  const auto open_where = [&open](auto is_one) {
    std::vector<Hypothesis*> some;
    std::ranges::copy_if(open, std::back_inserter(some), is_one);
    return some;
  };
  while (!open.empty()) {
    const Candidate& first = open.front()->candidate;
    const auto of_each_laser =
        open_where([&](const Hypothesis* other) { return other->candidate.term.term == first.term.term; });
    const auto of_family =
        open_where([&](const Hypothesis* other) { return other->candidate.is_of_family(first); });
    std::vector<Hypothesis*> judged = {open.front()};
    if (!selection.accepts(judged)) {
      for (const auto& some : {of_each_laser, of_family}) {
        if (some.size() < 2 || !selection.accepts(some)) continue;
        judged = some;
        break;
      }
    }
    std::erase_if(open, [&](Hypothesis* one) { return std::ranges::find(judged, one) != judged.end(); });
  }
}

}  // namespace crisp::diagnose
