// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/watch/calibration_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <crisp/rqe.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Sample;

constexpr std::uint64_t kSampleSeed = 1;  // the same beams each time

double rqe_of(const SensorModel& model, const Sample& sample, double sigma) {
  Vectors points;
  model.place(sample.beams, *sample.plate, [&](const PlacedRun& run) {
    points.x.insert(points.x.end(), run.x.begin(), run.x.end());
    points.y.insert(points.y.end(), run.y.begin(), run.y.end());
    points.z.insert(points.z.end(), run.z.begin(), run.z.end());
  });
  return rqe(points.view(), {}, {.sigma = sigma, .gradient = false, .error_bound = false}).value;
}

/// The plate is to cover the beams under either model, so that both place the same.
Sample covered_by_both(const Sample& sample, const Calibration& a, const Calibration& b) {
  double least = 0;
  double greatest = 0;
  for (const auto* calibration : {&a, &b}) {
    for (const auto& laser : calibration->lasers) {
      least = std::min(least, laser.eta.value);
      greatest = std::max(greatest, laser.eta.value);
    }
  }
  return estimate::covered(sample, least, greatest);
}

std::string format_change(const std::string& name, double by) {
  if (name.ends_with(".tau")) return fmt::format("{:.2g} mm", 1e3 * by);
  if (name.ends_with(".eta")) return fmt::format("{:.2g} ms", 1e3 * by);
  if (name.ends_with(".lambda") || name.ends_with(".alpha"))
    return fmt::format("{:.2g} deg", by / data::kDegree);
  return fmt::format("{:.3g}", by);
}

struct ParameterChange {
  double errors = 0;  ///< standard errors
  std::string text;
};

/// The free parameter that a refinement moved most, in its standard errors.
ParameterChange largest_change(const SensorModel& start, const estimate::Outcome& outcome) {
  ParameterChange most;
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(outcome.free[k]);
    const auto j = static_cast<Eigen::Index>(k);
    const double error = std::sqrt(outcome.covariance(j, j));
    const double by = outcome.model.values()[i] - start.values()[i];
    if (!(error > 0) || std::abs(by) / error <= most.errors) continue;
    const std::string& name = start.names()[outcome.free[k]];
    most = {std::abs(by) / error, fmt::format("{} by {} ({:.0f} standard errors)", name,
                                              format_change(name, by), std::abs(by) / error)};
  }
  return most;
}

/// The known geometry stays.
Calibration with_lags_of(Calibration calibration, const Calibration& other) {
  for (std::size_t i = 0; i < calibration.lasers.size(); ++i) calibration.lasers[i].eta = other.lasers[i].eta;
  calibration.covariance_order.clear();  // between this geometry and other lags there is none
  calibration.covariance.clear();
  return calibration;
}

/// The points of one check, and what is done with them.
class Checker {
 public:
  Checker(const Calibration& calibration, const Sample& sample, const Rig& rig, const TermRegistry& terms,
          const CheckSettings& settings, const std::function<bool()>& keep_running)
      : calibration_(calibration),
        sample_(sample),
        rig_(rig),
        settings_(settings),
        keep_running_(keep_running),
        start_(calibration, terms),
        thinned_(estimate::thin_evenly(sample, settings.beams, kSampleSeed)) {}

  CalibrationCheck check(RecalibrationPolicy policy) {
    const estimate::Refinement best = refine(settings_.refinement);
    const Sample few = estimate::thin_by_area(
        covered_by_both(sample_, calibration_, estimate::calibration_of(best.outcome, rig_)), start_,
        settings_.beams, kSampleSeed);
    CalibrationCheck check{.rqe = rqe_of(start_, few, settings_.sigma),
                           .best_rqe = rqe_of(best.outcome.model, few, settings_.sigma)};
    const ParameterChange most = largest_change(start_, best.outcome);
    check.moved = most.text;
    check.stale = check.rqe - check.best_rqe > settings_.tolerance && most.errors > settings_.significance;
    if (policy == RecalibrationPolicy::Yes || (policy == RecalibrationPolicy::IfStale && check.stale)) {
      check.recalibration = settings_.parameters == RecalibratedParameters::All
                                ? whole(best.outcome, check.best_rqe)
                                : lags(few);
    }
    return check;
  }

 private:
  estimate::Refinement refine(const estimate::RefinementSettings& settings) const {
    return estimate::refine_by_surfels(start_, thinned_, settings, [this](int) { return keep_running_(); });
  }

  /// With the geometry as it is, known as well as the calibration states.
  Recalibration lags(const Sample& few) const {
    estimate::RefinementSettings settings = settings_.refinement;
    for (const char* geometry : {"lambda", "tau", "alpha"}) settings.fixed.emplace_back(geometry);
    for (const LaserCalibration& laser : calibration_.lasers) {
      for (const auto& [name, known] : {std::pair("lambda", &laser.lambda), std::pair("tau", &laser.tau),
                                        std::pair("alpha", &laser.alpha)}) {
        settings.prior.nominal[laser.name + "." + name] = {.value = known->value,
                                                           .std_error = known->std_error};
      }
    }
    const estimate::Outcome outcome = refine(settings).outcome;
    Recalibration recalibration = whole(outcome, rqe_of(outcome.model, few, settings_.sigma));
    recalibration.calibration = with_lags_of(calibration_, recalibration.calibration);
    return recalibration;
  }

  Recalibration whole(const estimate::Outcome& outcome, double rqe) const {
    return {.calibration = estimate::calibration_of(outcome, rig_), .rqe = rqe, .caveats = outcome.caveats};
  }

  const Calibration& calibration_;
  const Sample& sample_;
  const Rig& rig_;
  const CheckSettings& settings_;
  const std::function<bool()>& keep_running_;
  SensorModel start_;
  Sample thinned_;
};

}  // namespace

CalibrationCheck check_calibration(const Calibration& calibration, const Sample& sample, const Rig& rig,
                                   const TermRegistry& terms, const CheckSettings& settings,
                                   RecalibrationPolicy policy, const std::function<bool()>& keep_running) {
  return Checker(calibration, sample, rig, terms, settings, keep_running).check(policy);
}

}  // namespace crisp::calibrate
