// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/model_extension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/estimate/placed_beams.hpp"
#include "plugins/diagnose/model/nonlinear_parameters.hpp"

namespace crisp::diagnose {
namespace {

/// Beams of the equations of a model that is to be tested: standard errors twice those of a million, and the
/// tests account for what parameters of the model are off by.
constexpr std::size_t kTestedBeams = 250'000;

std::set<std::string> names_of(const std::vector<Candidate>& candidates) {
  std::set<std::string> names;
  for (const auto& candidate : candidates) names.insert(candidate.name);
  return names;
}

std::set<std::string> names_of(const std::vector<Hypothesis>& hypotheses) {
  std::set<std::string> names;
  for (const auto& hypothesis : hypotheses) names.insert(hypothesis.candidate.name);
  return names;
}

bool is_new(const Hypothesis& hypothesis) { return !hypothesis.candidate.in_model; }

/// The stepwise search, with its state.
class ModelExtension {
 public:
  ModelExtension(const ModelFits& fits, const TermRegistry& terms, const DiagnosisSettings& settings,
                 const DiagnosisReporter& report)
      : fits_(fits), terms_(terms), settings_(settings), report_(report) {}

  void run(Diagnosis& result) {
    search(result);
    if (!fits_.explains_all(result.after)) return_to_one_that_explains_all(result);
  }

 private:
  /// A model that the search had.
  struct Tested {
    std::vector<Candidate> chosen;
    estimate::Refinement fit;
  };

  void search(Diagnosis& result) {
    for (round_ = 0; round_ <= settings_.rounds; ++round_) {
      progress(0, "testing all candidates");
      const SurfaceObservations& observations = fits_.observed(result.after);
      result.unshared = unshared_causes(terms_, observations.coverage());
      const CandidateSearch search = test(observations, result);
      result.settled = names_of(result.hypotheses) == names_of(chosen_);
      // A candidate selected in the last round would never be tested in a model that has it.
      if (round_ == settings_.rounds) std::erase_if(result.hypotheses, is_new);
      result.unobservable = search.unobservable(result.hypotheses);
      result.tests = search.tests();
      std::vector<Candidate> next;
      for (const Hypothesis& hypothesis : result.hypotheses) next.push_back(hypothesis.candidate);
      reject_dropped(next);
      if (names_of(next) == names_of(chosen_)) return;
      progress(0.7, "refining the extended model");
      const auto before = std::exchange(
          chosen_, refine_nonlinear(next, result.after.outcome.model, search.base(), observations,
                                    is_close_ ? settings_.refine_beams : settings_.beams, terms_));
      for (const Candidate& candidate : chosen_) {
        if (!candidate.other_forms.empty()) result.other_forms[candidate.name] = candidate.other_forms;
      }
      try {
        result.after = fits_.refined(with_terms(result.after.outcome.model.calibration(), chosen_, terms_),
                                     {.detail = estimate::Detail::kModel, .equation_beams = kTestedBeams});
        tested_.push_back({.chosen = chosen_, .fit = result.after});
      } catch (const estimate::UncoveredBeams&) {
        if (!reject_new_time_terms(before)) throw;
      }
    }
  }

  /// Each selection holds near its own model only, and may leave one that explains all. Of several the one
  /// that agrees best with its simulation.
  void return_to_one_that_explains_all(Diagnosis& result) {
    progress(0.9, "comparing the models that were tested");
    const auto found = std::ranges::max_element(
        tested_, {}, [this](const Tested& one) { return fits_.compared(one.fit).p_value; });
    if (found == tested_.end() || !fits_.explains_all(found->fit)) return;
    result.after = found->fit;
    const CandidateSearch tests(fits_.observed(result.after), result.after, terms_, settings_,
                                fits_.compared(result.after));
    result.hypotheses = tests.needs_of(found->chosen);
    result.unobservable = tests.unobservable(result.hypotheses);
    result.settled = names_of(result.hypotheses) == names_of(found->chosen);
  }

  void progress(double of_round, const char* what) const {
    fits_.stop_if_requested();
    const double fraction = 0.8 * (round_ + 0.25 + of_round) / (round_ + 2.25);
    if (report_) report_(fraction, fmt::format("round {}: {}", round_ + 1, what));
  }

  /// Whether smaller causes are resolvable: not next to an unexplained deviation, of which each would absorb
  /// a part.
  bool needs_refinement(const std::vector<Hypothesis>& found, const ProfileComparison& left) const {
    return settings_.refine_beams > settings_.beams &&
           std::ranges::all_of(found, [](const Hypothesis& one) { return one.candidate.is_cause(); }) &&
           left.p_value > settings_.selection.p_value;
  }

  /// Selects the candidates that the current model needs. If some were rejected, or if none is needed, the
  /// refined search follows.
  CandidateSearch test(const SurfaceObservations& observations, Diagnosis& result) {
    const bool may_be_fine = !rejected_.empty() && !is_close_;
    ProfileComparison left;
    if (may_be_fine) left = fits_.compared(result.after);
    CandidateSearch search(observations, result.after, terms_, settings_, left);
    if (!is_close_) {
      select(result, [&] { return search.needs(rejected_); });
      if (names_of(result.hypotheses) != names_of(chosen_)) return search;
      if (!may_be_fine) left = fits_.compared(result.after);
      is_close_ = needs_refinement(result.hypotheses, left);
      if (!is_close_) {
        if (may_be_fine) return search;
        CandidateSearch finer(observations, result.after, terms_, settings_, left);
        select(result, [&] { return finer.needs(rejected_); });
        // A deviation that no shape describes with these beams may be that of a small cause.
        is_close_ = result.hypotheses.empty() && settings_.refine_beams > settings_.beams;
        if (!is_close_) return finer;
      }
    }
    progress(0.4, "refining the search with more beams");
    select(result, [&] { return search.refine_search(rejected_); });
    return search;
  }

  /// Selects candidates, and rejects new ones by which the search would return to a model that was tested
  /// before: it would go in circles, such as between two members of a family.
  template <class Selection>
  void select(Diagnosis& result, const Selection& selected) {
    for (;;) {
      result.hypotheses = selected();
      const std::set<std::string> names = names_of(result.hypotheses);
      const bool was_tested =
          std::ranges::any_of(tested_, [&](const Tested& one) { return names_of(one.chosen) == names; });
      if (!was_tested || names == names_of(chosen_)) return;
      const std::size_t before = rejected_.size();
      for (const Hypothesis& one : result.hypotheses) {
        if (is_new(one)) rejected_.insert(one.candidate.name);
      }
      if (rejected_.size() == before) return;
    }
  }

  /// Rejects candidates of the model that the next one leaves out: they would be selected again in every
  /// round. One in whose place another came may come back once, since its tests were those of a model without
  /// the other.
  void reject_dropped(const std::vector<Candidate>& next) {
    const bool is_replaced = std::ranges::any_of(next, [](const Candidate& one) { return !one.in_model; });
    for (const std::string& name : names_of(chosen_)) {
      if (names_of(next).contains(name)) continue;
      if (!is_replaced || !replaced_.insert(name).second) rejected_.insert(name);
    }
  }

  /// Rejects new terms that move beams in time, where the model with them left the encoder readings: no clock
  /// is that wrong. Returns to the candidates before; false if none of the new ones is such a term.
  bool reject_new_time_terms(const std::vector<Candidate>& before) {
    const std::set<std::string> known = names_of(before);
    const std::size_t rejected = rejected_.size();
    for (const Candidate& one : chosen_) {
      if (known.contains(one.name)) continue;
      if (terms_.get(one.term.term)->info().phase == Phase::kTime) rejected_.insert(one.name);
    }
    chosen_ = before;
    return rejected_.size() > rejected;
  }

  const ModelFits& fits_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  const DiagnosisReporter& report_;
  int round_ = 0;
  std::vector<Candidate> chosen_;   ///< candidates of the current model
  std::set<std::string> rejected_;  ///< candidates that an earlier model had and did not need
  std::set<std::string> replaced_;  ///< candidates in whose place another came once
  std::vector<Tested> tested_;      ///< in the order of the search
  bool is_close_ = false;           ///< whether the refined search (more beams, causes only) runs
};

}  // namespace

void extend(Diagnosis& result, const ModelFits& fits, const TermRegistry& terms,
            const DiagnosisSettings& settings, const DiagnosisReporter& report) {
  ModelExtension(fits, terms, settings, report).run(result);
}

}  // namespace crisp::diagnose
