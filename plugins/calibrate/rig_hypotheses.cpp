// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_hypotheses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/requested_terms.hpp"
#include "pipeline/estimate/scene_repeat.hpp"
#include "plugins/calibrate/fit_check.hpp"
#include "plugins/calibrate/rig_check.hpp"
#include "plugins/calibrate/rig_search.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Sample;

constexpr std::size_t kBeams = 100'000;    // enough to see whether they fit
constexpr std::size_t kOwnBeams = 40'000;  // of one laser: some of each scan lie in the plate's plane
constexpr double kMore = 1.15;  // of the beams on flat surfaces, where the unchanged rig fits as well
constexpr double kSomeMore = 1.1, kMuchLessRest = 0.5;  // and the same with beams that lie on none
constexpr double kSteps = 20;                           // about as many changes as are tried
constexpr const char* kMirrorZero = "mount.mirror_zero";

/// "0.000" and not "-0.000".
double without_sign_of_zero(double value) { return std::abs(value) < 5e-4 ? 0 : value; }

/// "laser1.mount.mirror_zero" for each laser whose mirror sweeps: the mount of a single-beam device is not
/// identifiable.
std::vector<std::string> mount_terms(const Sample& sample, const Rig& rig) {
  std::vector<std::string> terms;
  for (const auto& [laser, sweep] : estimate::mirror_sweeps(sample.beams)) {
    if (sweep > estimate::kLeastSweep) terms.push_back(rig.lasers[laser].name + "." + kMirrorZero);
  }
  return terms;
}

/// A refinement with the mounts free; nothing if no surface is flat, or nothing is determined.
std::optional<estimate::Refinement> refined_with_mounts(const SensorModel& model, const Sample& sample,
                                                        const Rig& rig, const HypothesisSettings& settings) {
  Calibration start = model.calibration();
  estimate::RefinementSettings refinement = settings.refinement;
  for (auto& term : mount_terms(sample, rig)) refinement.terms.push_back(std::move(term));
  estimate::add_requested_terms(start, refinement.terms, *settings.terms);
  try {
    return estimate::refine_by_surfels(SensorModel(start, *settings.terms), sample, refinement,
                                       [&](int) { return !settings.interrupted(); });
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// A mount that is off by little.
struct MountError {
  std::size_t laser = 0;
  double mount = 0;      ///< [rad] that fits
  double std_error = 0;  ///< [rad]
};

/// Where `mount.mirror_zero` is clearly not 0 once it is free.
std::vector<MountError> mount_errors(const estimate::Refinement& refined, const Rig& rig) {
  constexpr double kMin = 0.1 * data::kDegree;  // 2 mm a metre
  constexpr double kClearly = 5;                // standard errors
  const Calibration found = estimate::calibration_of(refined.outcome, rig);
  std::vector<MountError> errors;
  for (std::size_t laser = 0; laser < rig.lasers.size(); ++laser) {
    for (const TermParameters& term : found.lasers[laser].terms) {
      if (term.term != kMirrorZero || term.parameters.empty()) continue;
      const Parameter& zero = term.parameters.front();
      if (!zero.free || std::abs(zero.value) < std::max(kMin, kClearly * zero.std_error)) continue;
      errors.push_back(
          {.laser = laser, .mount = rig.lasers[laser].mount - zero.value, .std_error = zero.std_error});
    }
  }
  return errors;
}

/// "mount: 87.1deg of laser1 (the rig has 90)", of lasers that the change leaves as they are.
std::vector<std::string> mounts_in_words(const std::vector<MountError>& errors, const Rig& rig,
                                         const RigChange& change) {
  std::vector<std::string> words;
  for (const MountError& error : errors) {
    if (change.exchanged || change.lasers[error.laser] != LaserChange{}) continue;
    words.push_back(mount_in_words(rig.lasers[error.laser], error.mount));
  }
  return words;
}

/// Changes with about as many beams on flat surfaces as the best one has.
std::vector<RigChange> nearly_best(std::vector<RigChange> changes, const std::vector<double>& beams) {
  constexpr double kNearly = 0.95;
  if (changes.empty()) return {};
  const double most = std::ranges::max(beams);
  std::vector<RigChange> best;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    if (beams[k] > kNearly * most) best.push_back(std::move(changes[k]));
  }
  return best;
}

/// Nothing if no change fits.
std::optional<std::string> caveat_of(const std::vector<RigChange>& fitting) {
  if (fitting.empty()) return std::nullopt;
  std::vector<std::string> words;
  for (const RigChange& change : fitting) words.push_back(change.words);
  return words.size() == 1
             ? fmt::format("the rig is probably wrong: the data fit with {}. Set it in the rig", words[0])
             : fmt::format(
                   "the rig is probably wrong: the data fit with one of {} corrections: {}. Find out on the scanner which one is true, and set it in the rig",
                   words.size(), fmt::join(words, "; or "));
}

}  // namespace

std::vector<std::string> check_mounts(const SensorModel& model, const Sample& sample, const Rig& rig,
                                      const HypothesisSettings& settings) {
  const Sample some = estimate::thin_evenly(sample, kBeams, 1);
  if (mount_terms(some, rig).empty()) return {};
  const auto refined = refined_with_mounts(model, some, rig, settings);
  if (settings.interrupted() || !refined || !refined->outcome.caveats.empty()) return {};
  const Calibration given = model.calibration();
  std::vector<std::string> caveats;
  for (const MountError& error : mount_errors(*refined, rig)) {
    if (std::ranges::count(given.lasers[error.laser].terms, kMirrorZero, &TermParameters::term) > 0) continue;
    const RigLaser& own = rig.lasers[error.laser];
    caveats.push_back(fmt::format(
        "{}'s mount is off: {:.3f} ± {:.3f} deg fits, the rig has {:.3f} deg. Set mount in the rig, or estimate it with calibrate.refine's terms: [{}]",
        own.name, without_sign_of_zero(error.mount / data::kDegree), error.std_error / data::kDegree,
        own.mount / data::kDegree, kMirrorZero));
  }
  return caveats;
}

bool RigErrorSearch::Fit::explains_all() const { return fits && kSomeMore * beams > all_beams; }

bool RigErrorSearch::Fit::explains_more_than(const Fit& other) const {
  if (!fits || !other.fits) return fits && beams > other.beams;
  if (beams < kOrdinaryShare * all_beams) return false;
  const bool leaves_much_less = all_beams - beams < kMuchLessRest * (other.all_beams - other.beams);
  return beams > kMore * other.beams || (beams > kSomeMore * other.beams && leaves_much_less);
}

RigErrorSearch::RigErrorSearch(const Sample& sample, const Rig& rig, HypothesisSettings settings)
    : sample_(estimate::thin_evenly(estimate::longest_recording(sample), kBeams, 1)),
      rig_(rig),
      settings_(std::move(settings)),
      period_(estimate::scene_repeat(sample)) {}

RigErrorSearch::Fit RigErrorSearch::fit_with(const RigChange& change, const Sample& sample) const {
  const ChangedSample changed(sample, change);
  HypothesisSettings settings = settings_;
  settings.refinement.angle_step *= std::abs(change.turn);
  RqeCalibrationSettings rqe;
  rqe.points = 10'000;
  rqe.probes = 4;
  rqe.in_plane.minimizer.interrupted = settings.interrupted;
  try {
    const SensorModel start(nominal_calibration(rig_), *settings.terms);
    rqe.in_plane.range = search_range_with_lambda(start, rig_, estimate::ParameterPrior{});
    const estimate::Outcome crisp = calibrate_by_rqe(start, changed.sample(), *settings.measure, rqe);
    if (settings.interrupted()) return {};
    const auto refined = refined_with_mounts(crisp.model, changed.sample(), rig_, settings);
    if (!refined) return {};
    Fit fit{.beams = static_cast<double>(refined->beams),
            .all_beams = static_cast<double>(sample.beams.size())};
    // Few determined parameters, as at a constant rate, show nothing against the change.
    const std::size_t harmless = refined->determines_little ? 1 : 0;
    if (refined->outcome.caveats.size() > harmless || !agrees_well(*refined)) return fit;
    const RigCheck check =
        check_with_rig(estimate::calibration_of(refined->outcome, rig_), rig_, estimate::ParameterPrior{});
    fit.fits = check.caveats.empty();
    if (check.is_explained) fit.mistake = check.caveats.front();
    fit.mounts = mounts_in_words(mount_errors(*refined, rig_), rig_, change);
    return fit;
  } catch (const Error&) {
    return {};  // RQE refuses the data with that
  }
}

const RigErrorSearch::Fit& RigErrorSearch::fit_of_rig() {
  if (!fit_of_rig_) fit_of_rig_ = fit_with(no_change(rig_), sample_);
  return *fit_of_rig_;
}

std::optional<std::string> RigErrorSearch::counts() {
  constexpr double kResolved = 0.003;  // of a turn
  if (!period_) return std::nullopt;
  if (estimate::contradicts_counts(*period_)) return estimate::counts_caveat(*period_);
  const double turns = period_->angle / (2 * std::numbers::pi);
  if (std::abs(turns - 1) <= kResolved) return std::nullopt;
  // A few thousandths change ranges by little, and a calibration adapts to them: with fewer beams.
  const Fit& unchanged = fit_of_rig();
  if (settings_.interrupted()) return std::nullopt;
  RigChange change = no_change(rig_);
  change.turn = 1 / turns;
  const Fit changed = fit_with(change, sample_);
  if (!changed.explains_more_than(unchanged) || changed.beams <= kMore * unchanged.beams) return std::nullopt;
  return estimate::counts_caveat(*period_);
}

std::optional<RigErrorSearch::Fit> RigErrorSearch::better_fit(const RigChange& change, const Sample& sample,
                                                              const Fit& unchanged) {
  if (settings_.interrupted()) return std::nullopt;
  if (settings_.report)
    settings_.report(std::min(0.99, static_cast<double>(step_++) / kSteps), "what if " + change.words);
  Fit changed = fit_with(change, sample);
  if (!changed.explains_more_than(unchanged)) return std::nullopt;
  return changed;
}

std::vector<RigChange> RigErrorSearch::those_that_fit(const std::vector<RigChange>& changes) {
  std::vector<RigChange> fitting;
  for (const RigChange& change : changes) {
    if (!fitting.empty() && !are_alike(fitting.front(), change)) continue;
    const auto fit = better_fit(change, sample_, fit_of_rig());
    if (!fit) continue;
    fitting.push_back(change);
    for (const auto& mount : fit->mounts) fitting.back().words += ", and " + mount;
  }
  return fitting;
}

std::vector<RigChange> RigErrorSearch::of_one(std::size_t laser) {
  const Sample own = estimate::thin_evenly(estimate::of_laser(sample_, laser), kOwnBeams, 1);
  if (own.beams.size() == 0) return {};
  const Fit unchanged = fit_with(no_change(rig_), own);
  if (unchanged.explains_all()) return {};
  std::vector<RigChange> better;
  std::vector<double> beams;
  for (RigChange& change : changes_of_laser(rig_, laser)) {
    const auto fit = better_fit(change, own, unchanged);
    if (!fit) continue;
    better.push_back(std::move(change));
    beams.push_back(fit->beams);
  }
  return nearly_best(std::move(better), beams);
}

std::vector<RigChange> RigErrorSearch::of_some() {
  constexpr std::size_t kMost = 8;
  std::vector<std::vector<RigChange>> alternatives;
  for (std::size_t laser = 0; laser < rig_.lasers.size(); ++laser) {
    auto own = of_one(laser);
    if (!own.empty()) alternatives.push_back(std::move(own));
  }
  return those_that_fit(combinations(alternatives, kMost));
}

std::vector<RigChange> RigErrorSearch::of_plate() {
  std::vector<RigChange> changes = {other_direction(rig_)};
  // Where the plate turned far enough, counts() has compared turns.
  if (!period_) std::ranges::move(other_counts(rig_), std::back_inserter(changes));
  return those_that_fit(changes);
}

std::vector<RigChange> RigErrorSearch::of_all() {
  auto found = those_that_fit(exchanges(rig_));
  return found.empty() ? those_that_fit(other_mounts(rig_)) : found;
}

std::optional<std::string> RigErrorSearch::factor_of_counts() {
  return period_ ? std::nullopt : caveat_of(those_that_fit(other_counts(rig_)));
}

std::optional<std::string> RigErrorSearch::any() {
  if (!fit_of_rig().mistake.empty()) return fit_of_rig().mistake;
  // A scene that wrong counts have squeezed can fit as well, by fewer beams.
  std::vector<RigChange> found = of_plate();
  if (found.empty() && fit_of_rig().fits && !fit_of_rig().mounts.empty()) {
    found.push_back(no_change(rig_));
    found.back().words = fmt::format("{}", fmt::join(fit_of_rig().mounts, " and "));
  }
  if (found.empty() && fit_of_rig().explains_all()) return std::nullopt;
  if (found.empty()) found = of_some();  // a tenth of the time that all lasers together take
  if (found.empty()) found = of_all();
  return caveat_of(found);
}

}  // namespace crisp::calibrate
