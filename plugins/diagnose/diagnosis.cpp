// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "pipeline/data/interrupted.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/model/terms_in.hpp"
#include "plugins/diagnose/borne_out.hpp"
#include "plugins/diagnose/evidence.hpp"
#include "plugins/diagnose/forms.hpp"
#include "plugins/diagnose/gate.hpp"
#include "plugins/diagnose/held_out.hpp"
#include "plugins/diagnose/unexplained.hpp"

namespace crisp {
namespace {

std::set<std::string> names_of(const std::vector<Candidate>& candidates) {
  std::set<std::string> names;
  for (const auto& candidate : candidates) names.insert(candidate.name);
  return names;
}

std::set<std::string> names_of(const std::vector<Departure>& departures) {
  std::set<std::string> names;
  for (const auto& departure : departures) names.insert(departure.candidate.name);
  return names;
}

bool is_new(const Departure& departure) { return !departure.candidate.in_model; }

class Diagnoser {
 public:
  Diagnoser(const SensorModel& start, const Sample& sample, const TermRegistry& terms,
            const DiagnosisSettings& settings, const DiagnosisReporter& report)
      : sample_(sample), terms_(terms), settings_(settings), report_(report), start_(start.calibration()) {}

  Diagnosis run() {
    tell(0, "refining without any terms");
    const Refinement plain = refined(with_terms(start_, {}), sample_);
    limit_lags(plain.outcome.model);
    Diagnosis result{.before = plain, .after = plain};
    extend(result);
    if (!result.departures.empty()) {
      tell(0.8, "judging by held-out turns");
      const HeldOut held_out(halves_of(inside_), result.before.outcome.model, settings_.refinement.surfels);
      const HeldOut::Score plain_score = score_on(held_out, result.before);
      judge(held_out, plain_score, result);
      compare(result);
      refuse_what_nothing_describes(result);
      if (std::ranges::any_of(result.departures, &Departure::accepted))
        result.gains = HeldOut::gains(plain_score, score_on(held_out, result.after));
    } else {
      compare(result);
    }
    add_form_errors(result);
    return result;
  }

 private:
  Refinement refined(const Calibration& calibration, const Sample& sample) const {
    RefinementSettings settings = settings_.refinement;
    settings.terms = terms_in(calibration, terms_);
    settings.forms = true;
    settings.prior.earliest_eta = lags_.earliest;
    settings.prior.latest_eta = lags_.latest;
    return refine_by_surfels(SensorModel(calibration, terms_), sample, settings, [this](int) {
      stop_if_asked();
      return true;
    });
  }

  /// Keeps the beams that the encoder readings cover at each η near that of the plain model, and each further
  /// refinement within these η: a start that was far off may have moved by more than its prior.
  void limit_lags(const SensorModel& plain) {
    lags_ = lag_range(plain, settings_.refinement.prior.eta);
    inside_ = covered(sample_, lags_.earliest, lags_.latest);
  }

  void stop_if_asked() const {
    if (settings_.interrupted && settings_.interrupted()) throw Interrupted();
  }
  void tell(double fraction, const std::string& what) const {
    stop_if_asked();
    if (report_) report_(fraction, what);
  }

  /// Whether fainter causes may be told: not beside what is off and has no cause, of which each would take a
  /// part.
  bool asks_for_a_closer_look(const std::vector<Departure>& found, const SideBySide& left) const {
    return settings_.closer > settings_.beams &&
           std::ranges::all_of(found, [](const Departure& one) { return one.candidate.is_cause(); }) &&
           left.p_value > settings_.selection.p_value;
  }

  /// How far the search has come.
  struct Search {
    std::vector<Candidate> chosen = {};  ///< that the model has
    std::set<std::string> refused = {};  ///< names of those that it had and did not need
    bool is_close = false;               ///< whether causes alone are looked for, with more beams
    std::function<void(double, const char*)> tell = {};
  };

  /// Finds what the model needs as it is. Where something was refused, or where nothing more is asked for, it
  /// may be that all that was looked for is too coarse for what departs.
  Survey look(const Evidence& evidence, Search& search, Diagnosis& result) const {
    const bool may_be_fine = !search.refused.empty() && !search.is_close;
    SideBySide left;
    if (may_be_fine) left = side_by_side(evidence, settings_.refinement.surfels, 1);
    Survey survey(evidence, result.after, terms_, settings_, left);
    if (!search.is_close) {
      result.departures = survey.needs(search.refused);
      if (names_of(result.departures) != names_of(search.chosen)) return survey;
      if (!may_be_fine) left = side_by_side(evidence, settings_.refinement.surfels, 1);
      search.is_close = asks_for_a_closer_look(result.departures, left);
      if (!search.is_close) {
        if (may_be_fine) return survey;
        Survey finer(evidence, result.after, terms_, settings_, left);
        result.departures = finer.needs(search.refused);
        return finer;
      }
    }
    search.tell(0.4, "looking closer");
    result.departures = survey.closer_needs(search.refused);
    return survey;
  }

  /// Adds what is needed, until nothing is missing.
  void extend(Diagnosis& result) const {
    Search search;
    for (int round = 0; round <= settings_.rounds; ++round) {
      search.tell = [this, round](double of_round, const char* what) {
        const double fraction = 0.8 * (round + 0.25 + of_round) / (round + 2.25);
        tell(fraction, fmt::format("round {}: {}", round + 1, what));
      };
      search.tell(0, "looking at all candidates");
      const Evidence evidence(result.after.outcome.model, inside_, settings_.refinement.surfels,
                              settings_.beams, settings_.interrupted);
      result.unshared = unshared_causes(terms_, evidence.coverage());
      const Survey survey = look(evidence, search, result);
      result.settled = names_of(result.departures) == names_of(search.chosen);
      // What is asked for in the end would not be looked at any more with the model that has it.
      if (round == settings_.rounds) std::erase_if(result.departures, is_new);
      result.unobservable = survey.unobservable(result.departures);
      result.looks = survey.looks();
      std::vector<Candidate> next;
      for (const Departure& departure : result.departures) next.push_back(departure.candidate);
      // What was found needless once the model had it would be taken again for ever.
      for (const std::string& name : names_of(search.chosen)) {
        if (!names_of(next).contains(name)) search.refused.insert(name);
      }
      if (names_of(next) == names_of(search.chosen)) return;
      search.tell(0.7, "refining with what was found");
      search.chosen = with_sharper_forms(next, result.after.outcome.model, survey.base(), evidence,
                                         search.is_close ? settings_.closer : settings_.beams, terms_);
      for (const Candidate& candidate : search.chosen) {
        if (!candidate.other_forms.empty()) result.other_forms[candidate.name] = candidate.other_forms;
      }
      result.after = refined(with_terms(result.after.outcome.model.calibration(), search.chosen), sample_);
    }
  }

  /// The refined model knows the curvature at its form alone, not that another may be the right one.
  static void add_form_errors(Diagnosis& result) {
    Outcome& outcome = result.after.outcome;
    for (const Departure& departure : result.departures) {
      const auto others = result.other_forms.find(departure.candidate.name);
      if (others == result.other_forms.end()) continue;
      const Eigen::MatrixXd added = form_covariance(others->second, departure.look.sharing());
      const auto places = places_of(departure.candidate, outcome);
      for (std::size_t p = 0; p < places.size(); ++p) {
        for (std::size_t q = 0; q < places.size(); ++q) {
          if (!places[p] || !places[q]) continue;
          outcome.covariance(*places[p], *places[q]) +=
              added(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q));
        }
      }
    }
  }

  /// Asks each departure of turns that models are not fitted to, and what comes out of those that pay.
  void judge(const HeldOut& held_out, const HeldOut::Score& plain, Diagnosis& result) const {
    refuse_what_may_be_the_scenes(result.departures);
    accept_what_pays(held_out, result.departures, plain, result.after.outcome.model.calibration(),
                     [this](const Calibration& start, const Sample& sample) {
                       return refined(start, sample).outcome.model;
                     });
    if (!std::ranges::all_of(result.departures, &Departure::accepted)) refine_with_accepted(result);
    while (refuse_what_is_not_borne_out(result.departures, result.after.outcome, terms_,
                                        settings_.selection.p_value)) {
      refine_with_accepted(result);
    }
  }

  void refine_with_accepted(Diagnosis& result) const {
    std::vector<Candidate> kept;
    for (const Departure& departure : result.departures) {
      if (departure.accepted) kept.push_back(departure.candidate);
    }
    const Calibration found = result.after.outcome.model.calibration();
    result.after = refined(with_terms(found, with_values_of(found, kept)), sample_);
  }

  /// Of the same terms, fitted to the other turns alone.
  HeldOut::Score score_on(const HeldOut& held_out, const Refinement& all) const {
    return held_out.score(refined(all.outcome.model.calibration(), held_out.fitted()).outcome.model);
  }

  SideBySide left_by(const Refinement& refinement) const {
    const Evidence evidence(refinement.outcome.model, inside_, settings_.refinement.surfels, settings_.beams);
    return side_by_side(evidence, settings_.refinement.surfels, 1);
  }

  void compare(Diagnosis& result) const {
    tell(0.9, "simulating the scanner again");
    result.left_before = left_by(result.before);
    result.left_after = result.departures.empty() ? result.left_before : left_by(result.after);
  }

  void refuse_what_nothing_describes(Diagnosis& result) const {
    const double noise = settings_.refinement.surfels.noise;
    while (refuse_what_leaves_more(result.departures, result.left_after, noise)) {
      refine_with_accepted(result);
      result.left_after = left_by(result.after);
    }
  }

  const Sample& sample_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  const DiagnosisReporter& report_;
  Calibration start_;
  LagRange lags_{.earliest = -std::numeric_limits<double>::infinity(),
                 .latest = std::numeric_limits<double>::infinity()};
  Sample inside_;
};

}  // namespace

Diagnosis diagnose(const SensorModel& start, const Sample& sample, const TermRegistry& terms,
                   const DiagnosisSettings& settings, const DiagnosisReporter& report) {
  return Diagnoser(start, sample, terms, settings, report).run();
}

}  // namespace crisp
