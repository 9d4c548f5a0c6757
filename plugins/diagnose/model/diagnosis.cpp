// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/model/terms_in.hpp"
#include "plugins/diagnose/model/acceptance.hpp"
#include "plugins/diagnose/model/cross_validation.hpp"
#include "plugins/diagnose/model/nonlinear_parameters.hpp"
#include "plugins/diagnose/model/per_model.hpp"
#include "plugins/diagnose/model/significance.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"

namespace crisp::diagnose {
namespace {

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

/// How exact a refinement is.
struct Effort {
  estimate::Detail detail = estimate::Detail::kViews;
  std::size_t equation_beams = std::numeric_limits<std::size_t>::max();
};

class Diagnoser {
 public:
  Diagnoser(const SensorModel& start, const estimate::Sample& sample, const TermRegistry& terms,
            const DiagnosisSettings& settings, const DiagnosisReporter& report)
      : sample_(sample), terms_(terms), settings_(settings), report_(report), start_(start.calibration()) {}

  Diagnosis run() {
    report(0, "refining without any terms");
    const estimate::Refinement plain = refined(with_terms(start_, {}));
    limit_lags(plain.outcome.model);
    Diagnosis result{.before = plain, .after = plain};
    extend(result);
    complete(result);
    if (!result.hypotheses.empty()) accept(result);
    report(0.9, "simulating the scanner");
    result.left_before = left_by(result.before);
    result.left_after = result.hypotheses.empty() ? result.left_before : left_by(result.after);
    if (has_open_questions(result)) result.proposals = proposed(result.after);
    add_form_errors(result);
    return result;
  }

 private:
  bool has_open_questions(const Diagnosis& result) const {
    return !result.unobservable.empty() || std::ranges::any_of(result.hypotheses, [&](const Hypothesis& one) {
      return one.accepted && !one.competitors.empty() &&
             one.competitors.front().behind < settings_.selection.odds;
    });
  }

  std::vector<RecordingProposal> proposed(const estimate::Refinement& fit) {
    report(0.95, "predicting other recordings");
    return propose_recordings(fit.outcome.model, base_of(fit), observed(fit), terms_, settings_);
  }

  CrossValidator validator_of(const SensorModel& chooser, std::uint32_t held_out) const {
    return {halves_of(inside_, held_out), chooser, settings_.refinement.surfels};
  }

  void accept(Diagnosis& result) {
    report(0.8, "cross-validating on held-out turns");
    const std::array validators = {validator_of(result.before.outcome.model, 0),
                                   validator_of(result.before.outcome.model, 1)};
    PerModel<CrossValidator::Score> scores;
    const HeldOutScore held_out = [&](const Calibration& start) {
      return scores.of(SensorModel(start, terms_), [&] {
        CrossValidator::Score score;
        for (const CrossValidator& validator : validators) {
          const auto fit = refined_with(validator.fitted(), start, {.detail = estimate::Detail::kModel});
          score.append(validator.score(fit.outcome.model));
        }
        return score;
      });
    };
    const CrossValidator::Score plain = held_out(result.before.outcome.model.calibration());
    accept_or_reject(result, plain,
                     {.held_out = held_out,
                      .refit = [this](const Calibration& start) { return refined(start); },
                      .compare = [this](const estimate::Refinement& fit) { return left_by(fit); }},
                     terms_, settings_, 0.5 * (sample_.plate->begin() + sample_.plate->end()));
    if (std::ranges::any_of(result.hypotheses, &Hypothesis::accepted))
      result.gains = CrossValidator::gains(plain, held_out(result.after.outcome.model.calibration()));
  }

  /// Beams of the equations of a model that is to be tested: standard errors twice those of a million, and
  /// the tests account for what parameters of the model are off by.
  static constexpr std::size_t kTestedBeams = 250'000;

  /// [standard errors] Steps below which a model is near enough to its optimum to be tested.
  static constexpr double kModelTolerance = 0.1;

  /// The start is a calibration. Where the model lacks a large effect, searches never agree with one another.
  static constexpr int kSearches = 4;

  /// A refinement with all beams.
  estimate::Refinement refined(const Calibration& calibration, const Effort& effort = {}) const {
    estimate::Refinement refinement = refined_with(sample_, calibration, effort);
    if (refinement.surfaces) surfaces_ = refinement.surfaces;
    return refinement;
  }

  estimate::Refinement refined_with(const estimate::Sample& sample, const Calibration& calibration,
                                    const Effort& effort) const {
    estimate::RefinementSettings settings = settings_.refinement;
    settings.detail = effort.detail;
    settings.equation_beams = effort.equation_beams;
    if (effort.detail == estimate::Detail::kModel) settings.tolerance = kModelTolerance;
    settings.terms = model::terms_in(calibration, terms_);
    settings.forms = true;
    settings.searches = kSearches;
    settings.prior.earliest_eta = lags_.earliest;
    settings.prior.latest_eta = lags_.latest;
    return estimate::refine_by_surfels(
        SensorModel(calibration, terms_), sample, settings,
        [this](int) {
          stop_if_requested();
          return true;
        },
        surfaces_);
  }

  /// Keeps the beams that the encoder readings cover at each η near the plain model's, and limits η to that
  /// neighbourhood in further refinements. A distant start may have moved by more than its prior.
  void limit_lags(const SensorModel& plain) {
    lags_ = estimate::lag_range(plain, settings_.refinement.prior.eta);
    inside_ = estimate::covered(sample_, lags_.earliest, lags_.latest);
  }

  void stop_if_requested() const {
    if (settings_.interrupted && settings_.interrupted()) throw Interrupted();
  }
  void report(double fraction, const std::string& what) const {
    stop_if_requested();
    if (report_) report_(fraction, what);
  }

  /// Whether smaller causes are resolvable: not next to an unexplained deviation, of which each would absorb
  /// a part.
  bool needs_refinement(const std::vector<Hypothesis>& found, const ProfileComparison& left) const {
    return settings_.refine_beams > settings_.beams &&
           std::ranges::all_of(found, [](const Hypothesis& one) { return one.candidate.is_cause(); }) &&
           left.p_value > settings_.selection.p_value;
  }

  /// State of the stepwise search.
  struct SearchState {
    std::vector<Candidate> chosen = {};   ///< candidates of the current model
    std::set<std::string> rejected = {};  ///< candidates that an earlier model had and did not need
    bool is_close = false;                ///< whether the refined search (more beams, causes only) runs
    std::function<void(double, const char*)> report = {};
  };

  /// Selects the candidates that the current model needs. If some were rejected, or if none is needed, the
  /// refined search follows.
  CandidateSearch test(const SurfaceObservations& observations, SearchState& state, Diagnosis& result) const {
    const bool may_be_fine = !state.rejected.empty() && !state.is_close;
    ProfileComparison left;
    if (may_be_fine) left = compared(result.after.outcome.model, observations);
    CandidateSearch search(observations, result.after, terms_, settings_, left);
    if (!state.is_close) {
      result.hypotheses = search.needs(state.rejected);
      if (names_of(result.hypotheses) != names_of(state.chosen)) return search;
      if (!may_be_fine) left = compared(result.after.outcome.model, observations);
      state.is_close = needs_refinement(result.hypotheses, left);
      if (!state.is_close) {
        if (may_be_fine) return search;
        CandidateSearch finer(observations, result.after, terms_, settings_, left);
        result.hypotheses = finer.needs(state.rejected);
        // A deviation that no shape describes with these beams may be that of a small cause.
        state.is_close = result.hypotheses.empty() && settings_.refine_beams > settings_.beams;
        if (!state.is_close) return finer;
      }
    }
    state.report(0.4, "refining the search with more beams");
    result.hypotheses = search.refine_search(state.rejected);
    return search;
  }

  /// Refines the extended model once more, with all beams and full standard errors: extend() leaves both out.
  void complete(Diagnosis& result) const {
    result.after =
        result.hypotheses.empty() ? result.before : refined(result.after.outcome.model.calibration());
  }

  /// Extends the model by the selected candidates until the selection adds nothing.
  void extend(Diagnosis& result) const {
    SearchState state;
    for (int round = 0; round <= settings_.rounds; ++round) {
      state.report = [this, round](double of_round, const char* what) {
        const double fraction = 0.8 * (round + 0.25 + of_round) / (round + 2.25);
        report(fraction, fmt::format("round {}: {}", round + 1, what));
      };
      state.report(0, "testing all candidates");
      const SurfaceObservations& observations = observed(result.after);
      result.unshared = unshared_causes(terms_, observations.coverage());
      const CandidateSearch search = test(observations, state, result);
      result.settled = names_of(result.hypotheses) == names_of(state.chosen);
      // A candidate selected in the last round would never be tested in a model that has it.
      if (round == settings_.rounds) std::erase_if(result.hypotheses, is_new);
      result.unobservable = search.unobservable(result.hypotheses);
      result.tests = search.tests();
      std::vector<Candidate> next;
      for (const Hypothesis& hypothesis : result.hypotheses) next.push_back(hypothesis.candidate);
      // Without this, a candidate rejected once would be selected again in every round.
      for (const std::string& name : names_of(state.chosen)) {
        if (!names_of(next).contains(name)) state.rejected.insert(name);
      }
      if (names_of(next) == names_of(state.chosen)) return;
      state.report(0.7, "refining the extended model");
      const auto before = std::exchange(
          state.chosen, refine_nonlinear(next, result.after.outcome.model, search.base(), observations,
                                         state.is_close ? settings_.refine_beams : settings_.beams, terms_));
      for (const Candidate& candidate : state.chosen) {
        if (!candidate.other_forms.empty()) result.other_forms[candidate.name] = candidate.other_forms;
      }
      try {
        result.after = refined(with_terms(result.after.outcome.model.calibration(), state.chosen),
                               {.detail = estimate::Detail::kModel, .equation_beams = kTestedBeams});
      } catch (const estimate::UncoveredBeams&) {
        if (!reject_new_time_terms(state, before)) throw;
      }
    }
  }

  /// Rejects new terms that move beams in time, where the model with them left the encoder readings: no clock
  /// is that wrong. Returns to the candidates before; false if none of the new ones is such a term.
  bool reject_new_time_terms(SearchState& state, const std::vector<Candidate>& before) const {
    const std::set<std::string> known = names_of(before);
    const std::size_t rejected = state.rejected.size();
    for (const Candidate& one : state.chosen) {
      if (known.contains(one.name)) continue;
      if (terms_.get(one.term.term)->info().phase == Phase::kTime) state.rejected.insert(one.name);
    }
    state.chosen = before;
    return state.rejected.size() > rejected;
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

  const ProfileComparison& compared(const SensorModel& model, const SurfaceObservations& observations) const {
    return comparisons_.of(
        model, [&] { return compare_with_simulation(observations, settings_.refinement.surfels, 1); });
  }

  ProfileComparison left_by(const estimate::Refinement& refinement) const {
    return comparisons_.of(refinement.outcome.model, [&] {
      return compare_with_simulation(observed(refinement), settings_.refinement.surfels, 1);
    });
  }

  /// The surfaces that a model was fitted to, for what follows with the same model. Valid until those of
  /// another.
  const SurfaceObservations& observed(const estimate::Refinement& fit) const {
    const SensorModel& model = fit.outcome.model;
    if (!observed_ || observed_->model.names() != model.names() ||
        !std::ranges::equal(observed_->model.values(), model.values())) {
      observed_.reset();
      observed_.emplace(
          Observed{.model = model,
                   .observations = {model, inside_, settings_.refinement, settings_.beams,
                                    settings_.interrupted, SurfacesOf::kRefinement, fit.surfaces.get()}});
    }
    return observed_->observations;
  }

  const estimate::Sample& sample_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  const DiagnosisReporter& report_;
  Calibration start_;
  estimate::LagRange lags_{.earliest = -std::numeric_limits<double>::infinity(),
                           .latest = std::numeric_limits<double>::infinity()};
  estimate::Sample inside_;
  struct Observed {
    SensorModel model;
    SurfaceObservations observations;
  };
  mutable std::optional<Observed> observed_;
  mutable std::shared_ptr<const estimate::SurfaceMap> surfaces_;  ///< of the last refinement with all beams
  mutable PerModel<ProfileComparison> comparisons_;
};

}  // namespace

Diagnosis diagnose(const SensorModel& start, const estimate::Sample& sample, const TermRegistry& terms,
                   const DiagnosisSettings& settings, const DiagnosisReporter& report) {
  return Diagnoser(start, sample, terms, settings, report).run();
}

}  // namespace crisp::diagnose
