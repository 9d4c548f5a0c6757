// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "plugins/diagnose/model/acceptance.hpp"
#include "plugins/diagnose/model/cross_validation.hpp"
#include "plugins/diagnose/model/model_extension.hpp"
#include "plugins/diagnose/model/model_fits.hpp"
#include "plugins/diagnose/model/nonlinear_parameters.hpp"
#include "plugins/diagnose/model/significance.hpp"

namespace crisp::diagnose {
namespace {

class Diagnoser {
 public:
  Diagnoser(const SensorModel& start, const estimate::Sample& sample, const TermRegistry& terms,
            const DiagnosisSettings& settings, const DiagnosisReporter& report)
      : terms_(terms),
        settings_(settings),
        report_(report),
        start_(start.calibration()),
        fits_(sample, terms, settings) {}

  Diagnosis run() {
    report(0, "refining without any terms");
    const estimate::Refinement plain = fits_.refined(with_terms(start_, {}, terms_));
    fits_.limit_lags(plain.outcome.model);
    Diagnosis result = search(plain);
    report(0.9, "simulating the scanner");
    result.left_before = fits_.compared(result.before);
    result.left_after = result.hypotheses.empty() ? result.left_before : fits_.compared(result.after);
    if (has_open_questions(result)) result.proposals = proposed(result.after);
    add_form_errors(result);
    return result;
  }

 private:
  /// Extends the plain model, and accepts or rejects the extensions.
  Diagnosis search(const estimate::Refinement& plain) const {
    Diagnosis result{.before = plain, .after = plain};
    extend(result, fits_, terms_, settings_, report_);
    if (result.hypotheses.empty()) {
      result.after = result.before;
    } else {
      // With all beams and full standard errors, which the search leaves out.
      result.after = fits_.refined(result.after.outcome.model.calibration());
      report(0.8, "cross-validating on held-out turns");
      accept(result);
    }
    return result;
  }

  bool has_open_questions(const Diagnosis& result) const {
    return !result.unobservable.empty() || std::ranges::any_of(result.hypotheses, [&](const Hypothesis& one) {
      return one.accepted && !one.competitors.empty() &&
             one.competitors.front().behind < settings_.selection.odds;
    });
  }

  std::vector<RecordingProposal> proposed(const estimate::Refinement& fit) {
    report(0.95, "predicting other recordings");
    return propose_recordings(fit.outcome.model, base_of(fit), fits_.observed(fit), terms_, settings_);
  }

  CrossValidator validator_of(const Diagnosis& result, std::uint32_t held_out) const {
    return {halves_of(fits_.covered(), held_out),
            {result.before.outcome.model, result.after.outcome.model},
            settings_.refinement.surfels};
  }

  void accept(Diagnosis& result) const {
    const std::array validators = {validator_of(result, 0), validator_of(result, 1)};
    PerModel<CrossValidator::Score> scores;
    const HeldOutScore held_out = [&](const Calibration& start) {
      return scores.of(SensorModel(start, terms_), [&] {
        CrossValidator::Score score;
        for (const CrossValidator& validator : validators) {
          const auto fit =
              fits_.refined_with(validator.fitted(), start, {.detail = estimate::Detail::kModel});
          score.append(validator.score(fit.outcome.model));
        }
        return score;
      });
    };
    const CrossValidator::Score plain = held_out(result.before.outcome.model.calibration());
    accept_or_reject(result, plain,
                     {.held_out = held_out,
                      .refit = [this](const Calibration& start) { return fits_.refined(start); },
                      .compare = [this](const estimate::Refinement& fit) { return fits_.compared(fit); }},
                     terms_, settings_);
    if (std::ranges::any_of(result.hypotheses, &Hypothesis::accepted))
      result.gains = CrossValidator::gains(plain, held_out(result.after.outcome.model.calibration()));
  }

  void report(double fraction, const std::string& what) const {
    fits_.stop_if_requested();
    if (report_) report_(fraction, what);
  }

  /// Adds the covariance over forms: the refinement gives only the curvature at the best form.
  static void add_form_errors(Diagnosis& result) {
    estimate::Outcome& outcome = result.after.outcome;
    for (const Hypothesis& hypothesis : result.hypotheses) {
      const auto others = result.other_forms.find(hypothesis.candidate.name);
      if (others == result.other_forms.end()) continue;
      const Eigen::MatrixXd added = form_covariance(others->second, hypothesis.test.design_effect());
      const auto places = parameter_indices(hypothesis.candidate, outcome);
      for (std::size_t p = 0; p < places.size(); ++p) {
        for (std::size_t q = 0; q < places.size(); ++q) {
          if (!places[p] || !places[q]) continue;
          outcome.covariance(*places[p], *places[q]) +=
              added(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q));
        }
      }
    }
  }

  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  const DiagnosisReporter& report_;
  Calibration start_;
  ModelFits fits_;
};

}  // namespace

Diagnosis diagnose(const SensorModel& start, const estimate::Sample& sample, const TermRegistry& terms,
                   const DiagnosisSettings& settings, const DiagnosisReporter& report) {
  return Diagnoser(start, sample, terms, settings, report).run();
}

}  // namespace crisp::diagnose
