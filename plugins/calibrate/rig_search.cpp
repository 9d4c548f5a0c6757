// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/fit_check.hpp"
#include "plugins/calibrate/report.hpp"
#include "plugins/calibrate/rig_check.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Outcome;
using estimate::ParameterPrior;

/// [nat] In ordinary rooms the next local minimum is 0.3 to 0.5 above the optimum.
constexpr double kClearlyCrisper = 0.1;

constexpr double kDeviations = 3;  // [standard deviations] of a nominal value: the search range
constexpr double kUsualLambda = 20 * data::kDegree;  // within which nominal λ are, unless the rig is wrong

double off(const Outcome& outcome, const ParameterPrior& range, std::size_t parameter) {
  return std::abs(estimate::picked(outcome.model, {parameter})[0] -
                  estimate::centres_of(range, outcome.model, {parameter})[0]);
}

/// Whether a parameter ended where its range ends, η apart.
bool is_at_limit(const Outcome& outcome, const ParameterPrior& range) {
  constexpr double kNear = 0.99;
  return std::ranges::any_of(outcome.free, [&](std::size_t parameter) {
    return range.nominal.contains(outcome.model.names()[parameter]) &&
           off(outcome, range, parameter) > kNear * estimate::ranges_of(range, outcome.model, {parameter})[0];
  });
}

/// Whether a λ is elsewhere than where the rig has it.
bool has_moved_lambda(const Outcome& outcome, const ParameterPrior& near) {
  return std::ranges::any_of(outcome.free, [&](std::size_t parameter) {
    return outcome.model.names()[parameter].ends_with(".lambda") &&
           off(outcome, near, parameter) > kUsualLambda;
  });
}

/// The outcome refined, with enough beams to see whether it fits; nothing if nothing is flat there, or
/// nothing is determined.
std::optional<estimate::Refinement> refined(const Outcome& outcome, const estimate::Sample& sample,
                                            const Rig& rig, const std::function<bool()>& interrupted) {
  constexpr std::size_t kBeams = 200'000;
  estimate::RefinementSettings settings;
  settings.prior.nominal = estimate::nominal_values(rig);
  try {
    return estimate::refine_by_surfels(outcome.model, estimate::thin_evenly(sample, kBeams, 1), settings,
                                       [&](int) { return !interrupted(); });
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Whether the refined calibration fits the data, and agrees with the rig.
bool fits(const std::optional<estimate::Refinement>& fit, const Rig& rig, const ParameterPrior& given) {
  return fit && fit->outcome.caveats.empty() && (fit->views.empty() || agrees_well(*fit)) &&
         check_with_rig(estimate::calibration_of(fit->outcome, rig), rig, given).caveats.empty();
}

std::function<bool()> interruption(const RqeCalibrationSettings& settings) {
  const auto& interrupted = settings.in_plane.minimizer.interrupted;
  return interrupted ? interrupted : [] { return false; };
}

}  // namespace

ParameterPrior search_range_around(const SensorModel& start, const Rig& rig, ParameterPrior range) {
  range.reach = kDeviations;
  range.nominal = estimate::nominal_values(rig);
  for (std::size_t laser = 0; laser < start.lasers(); ++laser) {
    for (const auto& [kind, reach] :
         {std::pair{estimate::kTau, range.tau}, std::pair{estimate::kAlpha, range.alpha}}) {
      const std::size_t parameter = estimate::slot(start, laser, kind);
      range.nominal.try_emplace(
          start.names()[parameter],
          estimate::NominalValue{.value = start.values()[static_cast<Eigen::Index>(parameter)],
                                 .std_error = reach / kDeviations});
    }
  }
  return range;
}

ParameterPrior search_range_with_lambda(const SensorModel& start, const Rig& rig,
                                        const ParameterPrior& given) {
  ParameterPrior range = search_range_around(start, rig, given);
  for (std::size_t laser = 0; laser < start.lasers(); ++laser) {
    const std::size_t parameter = estimate::slot(start, laser, estimate::kLambda);
    range.nominal.try_emplace(
        start.names()[parameter],
        estimate::NominalValue{.value = start.values()[static_cast<Eigen::Index>(parameter)],
                               .std_error = kUsualLambda / kDeviations});
  }
  return range;
}

Outcome search_around_rig(const SensorModel& start, const estimate::Sample& sample, Measure& measure,
                          RqeCalibrationSettings settings, const Rig& rig, const Reporter& report) {
  constexpr double kMore = 1.2;
  const ParameterPrior given = settings.in_plane.range;
  const auto interrupted = interruption(settings);
  const auto calibrated = [&](const ParameterPrior& range, double from, double share) {
    settings.in_plane.range = range;
    return calibrate_by_rqe(start, sample, measure, settings,
                            [&](double done, std::string_view what) { report(from + share * done, what); });
  };
  const ParameterPrior near = search_range_around(start, rig, given);
  const ParameterPrior nearest = search_range_with_lambda(start, rig, given);
  Outcome here = calibrated(near, 0, 0.5);
  const bool ends_here = is_at_limit(here, near);
  const bool moved = has_moved_lambda(here, nearest);
  if (interrupted() || (!ends_here && !moved && estimate::nominal_values(rig).empty())) return here;
  if (moved) {  // in a corridor both ways round fit
    Outcome nearer = calibrated(nearest, 0.5, 0.1);
    if (interrupted() || fits(refined(nearer, sample, rig, interrupted), rig, given)) return nearer;
  }
  report(0.6, "flat surfaces");
  const auto fit = refined(here, sample, rig, interrupted);
  if (interrupted() || fits(fit, rig, given)) return here;

  Outcome anywhere = calibrated(given, 0.7, 0.25);
  const double sigma = settings.full_field ? settings.sigma_to : settings.in_plane.sigma_to;
  const auto rqe =
      rqe_of({anywhere.model, here.model}, sample, {.sigma = sigma, .points = settings.points}, measure);
  const double clearly = ends_here ? 0 : kClearlyCrisper;
  if (interrupted() || rqe[0] + clearly > rqe[1]) return here;
  if (check_with_rig(estimate::calibration_of(anywhere, rig), rig, given).is_explained) return anywhere;
  report(0.95, "flat surfaces");
  const auto other = refined(anywhere, sample, rig, interrupted);
  const auto beams_of = [](const std::optional<estimate::Refinement>& refinement) {
    return refinement ? static_cast<double>(refinement->beams) : 0.0;
  };
  return beams_of(other) > kMore * beams_of(fit) ? std::move(anywhere) : std::move(here);
}

DirectedOutcome search_in_both_directions(const SensorModel& start, const estimate::Sample& sample,
                                          Measure& measure, const RqeCalibrationSettings& settings,
                                          const Rig& rig, const Reporter& report) {
  const ParameterPrior& given = settings.in_plane.range;
  const auto interrupted = interruption(settings);
  const auto searched = [&](const estimate::Sample& beams, double from) {
    return search_around_rig(start, beams, measure, settings, rig,
                             [&](double done, std::string_view what) { report(from + 0.5 * done, what); });
  };
  DirectedOutcome as_read{.outcome = searched(sample, 0)};
  const auto fit = refined(as_read.outcome, sample, rig, interrupted);
  const bool is_mirrored =
      fit && check_with_rig(estimate::calibration_of(fit->outcome, rig), rig, given).is_mirrored;
  if (interrupted() || is_mirrored || fits(fit, rig, given)) return as_read;
  const PlateTrajectory plate = data::reversed(*sample.plate);
  const estimate::Sample turned{.beams = sample.beams, .plate = &plate};
  DirectedOutcome reversed{.outcome = searched(turned, 0.5), .direction = CountDirection::clockwise};
  const auto other = refined(reversed.outcome, turned, rig, interrupted);
  return !interrupted() && fits(other, rig, given) ? std::move(reversed) : std::move(as_read);
}

}  // namespace crisp::calibrate
