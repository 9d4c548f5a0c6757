// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_hypotheses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/mirror_angle.hpp"
#include "pipeline/estimate/requested_terms.hpp"
#include "pipeline/estimate/turn_period.hpp"
#include "plugins/calibrate/fit_check.hpp"
#include "plugins/calibrate/rig_check.hpp"
#include "plugins/calibrate/rig_search.hpp"

namespace crisp {
namespace {

constexpr std::size_t kBeams = 100'000;  // enough to see whether they fit
constexpr const char* kMirrorZero = "mount.mirror_zero";

/// A possible correction of the rig.
struct RigHypothesis {
  std::string change;  ///< in words: "plate.direction: clockwise"
  double turn = 1;     ///< by which the plate's angles are multiplied; −1: it counts the other way
  std::vector<double> mount_turns;  ///< [rad] by which each laser's mount is greater
};

constexpr std::array kTurns = {180 * kDegree, 90 * kDegree, -90 * kDegree, 45 * kDegree, -45 * kDegree};

std::string with_mount(const RigLaser& laser, double turn) {
  const double mount = std::remainder(laser.mount + turn, 2 * std::numbers::pi);
  return fmt::format("mount: {:.4g}deg of {} (the rig has {:.4g})", mount / kDegree, laser.name,
                     laser.mount / kDegree);
}

/// Possible mistakes of the plate, or of all lasers alike.
std::vector<RigHypothesis> common_hypotheses(const Rig& rig) {
  const std::size_t n = rig.lasers.size();
  const bool is_clockwise = rig.plate.direction == CountDirection::clockwise;
  std::vector<RigHypothesis> all = {
      {.change = fmt::format("plate.direction: {}", is_clockwise ? "counter_clockwise" : "clockwise"),
       .turn = -1,
       .mount_turns = std::vector<double>(n, 0.0)}};
  for (const double turn : kTurns) {
    RigHypothesis hypothesis{.change = with_mount(rig.lasers[0], turn),
                             .mount_turns = std::vector<double>(n, turn)};
    if (n > 1) hypothesis.change += " and the mounts of the others turned alike";
    all.push_back(std::move(hypothesis));
  }
  return all;
}

/// The data as they would be with the rig changed.
class ChangedSample {
 public:
  ChangedSample(const Sample& sample, const RigHypothesis& hypothesis) : sample_(sample) {
    for (std::size_t i = 0; i < sample_.beams.size(); ++i) {
      float& angle = sample_.beams.mirror_angle[i];
      angle =
          static_cast<float>(wrapped_mirror_angle(angle - hypothesis.mount_turns[sample_.beams.laser[i]]));
    }
    const PlateTrajectory& plate = *sample.plate;
    std::vector<double> angles;
    for (const double angle : plate.angles()) angles.push_back(hypothesis.turn * angle);
    plate_ = plate.with_angles(std::move(angles));
    sample_.plate = &plate_;
  }
  ChangedSample(const ChangedSample&) = delete;
  ChangedSample& operator=(const ChangedSample&) = delete;
  ~ChangedSample() = default;

  const Sample& sample() const { return sample_; }

 private:
  Sample sample_;
  PlateTrajectory plate_;
};

/// "0.000" and not "-0.000".
double without_sign_of_zero(double value) { return std::abs(value) < 5e-4 ? 0 : value; }

/// "laser1.mount.mirror_zero" for each laser whose mirror sweeps: the mount of a single-beam device is not
/// identifiable.
std::vector<std::string> mount_terms(const Sample& sample, const Rig& rig) {
  constexpr float kSweep = 30 * kDegree;
  std::vector<std::string> terms;
  for (std::size_t laser = 0; laser < rig.lasers.size(); ++laser) {
    const Sample own = of_laser(sample, laser);
    if (own.beams.size() == 0) continue;
    const auto [first, last] = std::ranges::minmax(own.beams.mirror_angle);
    if (last - first > kSweep) terms.push_back(rig.lasers[laser].name + "." + kMirrorZero);
  }
  return terms;
}

/// A refinement with the mounts free; nothing if no surface is flat, or nothing is determined.
std::optional<Refinement> refined_with_mounts(const SensorModel& model, const Sample& sample, const Rig& rig,
                                              const HypothesisSettings& settings) {
  Calibration start = model.calibration();
  RefinementSettings refinement = settings.refinement;
  for (auto& term : mount_terms(sample, rig)) refinement.terms.push_back(std::move(term));
  add_requested_terms(start, refinement.terms, *settings.terms);
  try {
    return refine_by_surfels(SensorModel(start, *settings.terms), sample, refinement,
                             [&](int) { return !settings.interrupted(); });
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// How well the data fit with a changed rig.
struct HypothesisFit {
  bool fits = false;      ///< without a caveat, and in agreement with the nominal values
  std::size_t beams = 0;  ///< on flat surfaces: a wrong rig may fold the scene onto a few of them
};

HypothesisFit fit_with(const RigHypothesis& hypothesis, const Sample& sample, const Rig& rig,
                       const HypothesisSettings& settings) {
  const ChangedSample changed(sample, hypothesis);
  RqeCalibrationSettings rqe;
  rqe.points = 10'000;
  rqe.probes = 4;
  rqe.in_plane.minimizer.interrupted = settings.interrupted;
  try {
    const SensorModel start(nominal_calibration(rig), *settings.terms);
    rqe.in_plane.range = search_range_with_lambda(start, rig, ParameterPrior{});
    const Outcome crisp = calibrate_by_rqe(start, changed.sample(), *settings.measure, rqe);
    if (settings.interrupted()) return {};
    const auto refined = refined_with_mounts(crisp.model, changed.sample(), rig, settings);
    if (!refined) return {};
    const bool fits =
        refined->outcome.caveats.empty() && agrees_well(*refined) &&
        check_with_rig(calibration_of(refined->outcome, rig), rig, ParameterPrior{}).caveats.empty();
    return {.fits = fits, .beams = refined->beams};
  } catch (const Error&) {
    return {};  // RQE refuses the data with that
  }
}

/// The mount with which one laser's own beams fit, if they do not with the rig's.
std::optional<std::string> mount_of_one(std::size_t laser, const Sample& sample, const Rig& rig,
                                        const HypothesisSettings& settings) {
  const Sample own = of_laser(sample, laser);
  const auto fit = [&](double turn) {
    RigHypothesis hypothesis{.change = {}, .mount_turns = std::vector<double>(rig.lasers.size(), 0.0)};
    hypothesis.mount_turns[laser] = turn;
    return fit_with(hypothesis, own, rig, settings);
  };
  if (own.beams.size() == 0) return std::nullopt;
  const HypothesisFit unchanged = fit(0);
  for (const double turn : kTurns) {
    if (unchanged.fits || settings.interrupted()) break;
    const HypothesisFit changed = fit(turn);
    if (changed.fits && changed.beams > unchanged.beams) return with_mount(rig.lasers[laser], turn);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> check_mounts(const SensorModel& model, const Sample& sample, const Rig& rig,
                                      const HypothesisSettings& settings) {
  constexpr double kMin = 0.1 * kDegree;  // 2 mm a metre
  constexpr double kClearly = 5;          // standard errors
  std::vector<std::string> caveats;
  const Sample some = thin_evenly(sample, kBeams, 1);
  if (mount_terms(some, rig).empty()) return {};
  const auto refined = refined_with_mounts(model, some, rig, settings);
  if (settings.interrupted() || !refined || !refined->outcome.caveats.empty()) return {};
  const Calibration found = calibration_of(refined->outcome, rig);
  for (std::size_t laser = 0; laser < rig.lasers.size(); ++laser) {
    for (const TermParameters& term : found.lasers[laser].terms) {
      if (term.term != kMirrorZero || term.parameters.empty()) continue;
      const Parameter& zero = term.parameters.front();
      if (!zero.free || std::abs(zero.value) < std::max(kMin, kClearly * zero.std_error)) continue;
      const RigLaser& own = rig.lasers[laser];
      caveats.push_back(fmt::format(
          "{}'s mount is off: {:.3f} ± {:.3f} deg fits, the rig has {:.3f} deg. Set mount in the rig, or estimate it with calibrate.refine's terms: [{}]",
          own.name, without_sign_of_zero((own.mount - zero.value) / kDegree), zero.std_error / kDegree,
          own.mount / kDegree, kMirrorZero));
    }
  }
  return caveats;
}

std::optional<std::string> check_counts(const Sample& sample, const Rig& rig,
                                        const HypothesisSettings& settings) {
  constexpr double kResolved = 0.003;  // of a turn
  constexpr double kMore = 1.15;       // of the beams on flat surfaces
  const auto period = turn_period(sample);
  if (!period) return std::nullopt;
  if (contradicts_counts(*period)) return counts_caveat(*period);
  const double turns = period->angle / (2 * std::numbers::pi);
  if (std::abs(turns - 1) <= kResolved) return std::nullopt;
  // A few thousandths change ranges by little, and a calibration adapts to them: with fewer beams.
  const Sample some = thin_evenly(longest_recording(sample), kBeams, 1);
  RigHypothesis hypothesis{.change = {}, .mount_turns = std::vector<double>(rig.lasers.size(), 0.0)};
  const HypothesisFit unchanged = fit_with(hypothesis, some, rig, settings);
  if (settings.interrupted()) return std::nullopt;
  hypothesis.turn = 1 / turns;
  const HypothesisFit changed = fit_with(hypothesis, some, rig, settings);
  const bool is_better =
      changed.fits && static_cast<double>(changed.beams) > kMore * static_cast<double>(unchanged.beams);
  if (!is_better) return std::nullopt;
  return counts_caveat(*period);
}

std::optional<std::string> find_rig_error(const Sample& sample, const Rig& rig,
                                          const HypothesisSettings& settings) {
  const Sample some = thin_evenly(longest_recording(sample), kBeams, 1);
  // Where the rig as it stands fits as well, by the same few beams, no change of it explains anything.
  const RigHypothesis as_it_stands{.change = {}, .mount_turns = std::vector<double>(rig.lasers.size(), 0.0)};
  const HypothesisFit unchanged = fit_with(as_it_stands, some, rig, settings);
  if (unchanged.fits) return std::nullopt;
  const auto all = common_hypotheses(rig);
  const double steps = static_cast<double>(all.size() + rig.lasers.size());
  const auto report = [&](std::size_t step, const std::string& what) {
    if (settings.report) settings.report(static_cast<double>(step) / steps, "what if " + what);
  };
  std::vector<std::string> changes;
  for (std::size_t k = 0; k < all.size() && changes.empty() && !settings.interrupted(); ++k) {
    report(k, all[k].change);
    const HypothesisFit changed = fit_with(all[k], some, rig, settings);
    if (changed.fits && changed.beams > unchanged.beams) changes.push_back(all[k].change);
  }
  for (std::size_t laser = 0; changes.empty() && rig.lasers.size() > 1 && laser < rig.lasers.size();
       ++laser) {
    report(all.size() + laser, "another mount of " + rig.lasers[laser].name);
    if (auto change = mount_of_one(laser, some, rig, settings)) changes.push_back(std::move(*change));
  }
  if (changes.empty()) return std::nullopt;
  return fmt::format("the rig is probably wrong: the data fit with {}. Set it in the rig",
                     fmt::join(changes, ", "));
}

}  // namespace crisp
