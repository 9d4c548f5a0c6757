// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/wanted_terms.hpp"
#include "pipeline/model/terms_in.hpp"
#include "plugins/diagnose/evidence.hpp"
#include "plugins/diagnose/forms.hpp"
#include "plugins/diagnose/gate.hpp"
#include "plugins/diagnose/held_out.hpp"

namespace crisp {
namespace {

std::set<std::string> names_of(const std::vector<Candidate>& candidates) {
  std::set<std::string> names;
  for (const auto& candidate : candidates) names.insert(candidate.name);
  return names;
}

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

/// Candidates that could be a quarter of the noise of ranges, in every form, without being seen beside those
/// that were taken.
///
/// @param noise  [m] of ranges
std::vector<Diagnosis::Limit> hidden(const std::vector<std::size_t>& taken, const Dictionary& dictionary,
                                     const NormalEquations& equations, const SelectionSettings& settings,
                                     double noise) {
  constexpr double kMuch = 0.25;
  struct Least {
    double limit = 0;
    std::size_t candidate = 0;
  };
  const auto looks = looks_beside(taken, dictionary, equations);
  std::map<std::string, Least> limits;
  for (std::size_t c = 0; c < looks.size(); ++c) {
    const Candidate& candidate = dictionary.candidates()[c];
    if (!looks[c] || !candidate.is_cause()) continue;
    const Least own{.limit = limit_of(candidate, *looks[c], settings, equations.beams), .candidate = c};
    const auto [known, is_new] = limits.try_emplace(candidate.name, own);
    if (own.limit < known->second.limit) known->second = own;
  }
  std::vector<Diagnosis::Limit> hidden;
  for (const auto& [name, least] : limits) {
    if (least.limit < kMuch * noise) continue;
    hidden.push_back({.name = name,
                      .size = least.limit,
                      .combination = known_instead(least.candidate, taken, dictionary, equations)});
  }
  return hidden;
}

/// One look at a model: what it needs, as candidates with values.
void look(const Evidence& evidence, const TermRegistry& terms, const DiagnosisSettings& settings,
          const std::set<std::string>& refused, Diagnosis& result) {
  const SensorModel& model = result.after.outcome.model;
  const Dictionary dictionary(model, base_of(result.after),
                              candidates(terms, model.calibration(), evidence.lasting()), terms);
  const NormalEquations equations = from_neutral(dictionary, evidence.equations(dictionary));
  result.departures.clear();
  std::vector<std::size_t> taken;
  for (const Choice& choice : choose(dictionary, equations, settings.selection, refused)) {
    taken.push_back(choice.candidate);
    result.departures.push_back(
        {.candidate = valued(dictionary.candidates()[choice.candidate], choice.look, terms),
         .look = choice.look,
         .rivals = rivals(choice, dictionary),
         .gains = {}});
  }
  result.unobservable =
      hidden(taken, dictionary, equations, settings.selection, settings.refinement.surfels.noise);
  result.looks = names_of(dictionary.candidates()).size();
  result.unshared = unshared_causes(terms, evidence.lasting());
}

class Diagnoser {
 public:
  Diagnoser(const SensorModel& start, const Sample& sample, const TermRegistry& terms,
            const DiagnosisSettings& settings, const DiagnosisReporter& report)
      : sample_(sample), terms_(terms), settings_(settings), report_(report), start_(start.calibration()) {
    const LagRange lag = lag_range(start, settings.refinement.prior.eta);
    inside_ = covered(sample, lag.earliest, lag.latest);
  }

  Diagnosis run() {
    const Refinement plain = refined(with_terms(start_, {}), sample_);
    Diagnosis result{.before = plain, .after = plain};
    extend(result);
    if (!goes_on(1, "judging by held-out turns")) return result;
    judge(result);
    if (!goes_on(1, "simulating the scanner again")) return result;
    compare(result);
    refuse_what_leaves_more(result);
    add_form_errors(result);
    return result;
  }

 private:
  Refinement refined(const Calibration& calibration, const Sample& sample) const {
    RefinementSettings settings = settings_.refinement;
    settings.terms = terms_in(calibration, terms_);
    settings.forms = true;
    return refine_by_surfels(SensorModel(calibration, terms_), sample, settings,
                             [this](int) { return goes_on(told_.first, told_.second); });
  }
  bool goes_on(double share, const std::string& what) const {
    told_ = {share, what};
    return !report_ || report_(share, what);
  }

  /// Adds what is needed, until nothing is missing.
  void extend(Diagnosis& result) const {
    std::vector<Candidate> chosen;
    std::set<std::string> refused;
    for (int round = 0; round < settings_.rounds; ++round) {
      const double share = round / (settings_.rounds + 2.0);
      if (!goes_on(share, fmt::format("round {}: looking at all candidates", round + 1))) return;
      const Evidence evidence(result.after.outcome.model, inside_, settings_.refinement.surfels,
                              settings_.beams);
      look(evidence, terms_, settings_, refused, result);
      std::vector<Candidate> next;
      for (const Departure& departure : result.departures) next.push_back(departure.candidate);
      // What was found needless once the model had it would be taken again for ever.
      for (const std::string& name : names_of(chosen)) {
        if (!names_of(next).contains(name)) refused.insert(name);
      }
      result.settled = names_of(next) == names_of(chosen);
      if (result.settled) return;
      if (!goes_on(share, fmt::format("round {}: refining with what was found", round + 1))) return;
      chosen = with_sharper_forms(next, result.after.outcome.model, base_of(result.after), evidence, terms_);
      for (const Candidate& candidate : chosen) {
        if (!candidate.other_forms.empty()) result.other_forms[candidate.name] = candidate.other_forms;
      }
      result.after = refined(with_terms(result.after.outcome.model.calibration(), chosen), sample_);
    }
  }

  /// Where each parameter of a candidate's term is among those that were estimated; nothing for those that
  /// were not.
  std::vector<std::optional<Eigen::Index>> places_of(const Candidate& candidate,
                                                     const Outcome& outcome) const {
    const bool of_plate = candidate.owner == start_.lasers.size();
    std::vector<std::optional<Eigen::Index>> places(candidate.term.parameters.size());
    for (std::size_t p = 0; p < places.size(); ++p) {
      const std::string name =
          (of_plate ? "plate." : "") + candidate.name + "." + candidate.term.parameters[p].name;
      for (std::size_t k = 0; k < outcome.free.size(); ++k) {
        if (outcome.model.names()[outcome.free[k]] == name) places[p] = static_cast<Eigen::Index>(k);
      }
    }
    return places;
  }

  /// The refined model knows the curvature at its form alone, not that another may be the right one.
  void add_form_errors(Diagnosis& result) const {
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

  /// Asks each departure of turns that models are not fitted to.
  void judge(Diagnosis& result) const {
    if (result.departures.empty()) return;
    const HeldOut held_out(halves_of(inside_), result.before.outcome.model, settings_.refinement.surfels);
    const Calibration found = result.after.outcome.model.calibration();
    const auto accepted = accepted_by(
        held_out, result.departures, result.before.outcome.model.calibration(), found,
        [this](const Calibration& start, const Sample& sample) {
          return refined(start, sample).outcome.model;
        },
        [this] { return goes_on(1, "judging by held-out turns"); });
    if (accepted.size() < result.departures.size()) {
      result.after = refined(with_terms(found, accepted), sample_);
    }
  }

  SideBySide left_by(const Refinement& refinement) const {
    const Evidence evidence(refinement.outcome.model, inside_, settings_.refinement.surfels, settings_.beams);
    return side_by_side(evidence, settings_.refinement.surfels, 1);
  }

  void compare(Diagnosis& result) const {
    result.left_before = left_by(result.before);
    result.left_after = result.departures.empty() ? result.left_before : left_by(result.after);
  }

  /// That alone whose ranges it changes; nothing of what the plate does, which changes all.
  std::optional<std::size_t> laser_of(const Departure& departure) const {
    const std::size_t owner = departure.candidate.owner;
    return owner < start_.lasers.size() ? std::optional(owner) : std::nullopt;
  }

  /// [m²] Over the covariate that shows the most: what departs from the extended model where this departure
  /// is, and the shapes that do not suffice there.
  double unexplained_beside(const Departure& one, const Diagnosis& result) const {
    const auto laser = laser_of(one);
    auto squares = result.left_after.unexplained(laser);
    for (const Departure& shape : result.departures) {
      const bool is_there = !laser || shape.candidate.owner == one.candidate.owner;
      if (shape.candidate.is_cause() || !shape.accepted || !is_there) continue;
      const auto left = squares.find(shape.candidate.covariate);
      if (left != squares.end()) left->second += shape.square(settings_.refinement.surfels.noise);
    }
    double most = 0;
    for (const auto& [covariate, square] : squares) most = std::max(most, square);
    return most;
  }

  /// Where much is left that nothing tried describes, the nearest name takes a part of that.
  void refuse_what_leaves_more(Diagnosis& result) const {
    std::vector<Candidate> kept;
    bool refuses = false;
    for (Departure& departure : result.departures) {
      if (!departure.accepted) continue;
      departure.unexplained = departure.candidate.is_cause() ? unexplained_beside(departure, result) : 0;
      departure.leaves_more = departure.square(settings_.refinement.surfels.noise) < departure.unexplained;
      refuses = refuses || departure.leaves_more;
      if (!departure.leaves_more) kept.push_back(departure.candidate);
    }
    for (Departure& departure : result.departures) {
      departure.accepted = departure.accepted && !departure.leaves_more;
    }
    if (!refuses) return;
    const Calibration found = result.after.outcome.model.calibration();
    result.after = refined(with_terms(found, with_values_of(found, kept)), sample_);
    result.left_after = left_by(result.after);
  }

  const Sample& sample_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  const DiagnosisReporter& report_;
  Calibration start_;
  Sample inside_;
  mutable std::pair<double, std::string> told_;  ///< last: told again with each round of a refinement
};

}  // namespace

Diagnosis diagnose(const SensorModel& start, const Sample& sample, const TermRegistry& terms,
                   const DiagnosisSettings& settings, const DiagnosisReporter& report) {
  return Diagnoser(start, sample, terms, settings, report).run();
}

}  // namespace crisp
