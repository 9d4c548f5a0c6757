// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/basin.hpp"

#include <algorithm>
#include <cmath>

#include <crisp/error.hpp>

#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::study {
namespace {

/// Result of a calibration.
struct End {
  SensorModel model;
  Eigen::VectorXd std_error;         // of the parameters that it turned
  std::vector<std::size_t> free;     // which they are
  std::vector<std::string> caveats;  // of the calibration
};

void add(std::vector<std::string>& to, const std::vector<Unobservable>& unobservable) {
  for (const Unobservable& u : unobservable) to.push_back(u.parameter + " is not observable: " + u.reason);
}

/// calibrate.refine.
/// @throws Error  as it does
End refined(const SensorModel& start, const estimate::Sample& sample, const TrialSettings& settings) {
  estimate::RefinementSettings refinement = settings.refinement;
  refinement.surfels.noise = settings.noise;
  const estimate::Refinement found = estimate::refine_by_surfels(start, sample, refinement);
  End end{.model = found.outcome.model,
          .std_error = found.outcome.covariance.diagonal().cwiseSqrt(),
          .free = found.outcome.free,
          .caveats = found.outcome.caveats};
  add(end.caveats, found.outcome.unobservable);
  return end;
}

/// calibrate.rqe and calibrate.refine.
/// @throws Error  as they do
End calibrated(const SensorModel& start, const estimate::Sample& sample, const TrialSettings& settings,
               Measure& measure) {
  calibrate::RqeCalibrationSettings rqe = settings.rqe;
  rqe.full_field = settings.beams == BeamChoice::kAll;
  rqe.noise = settings.noise;
  const estimate::Outcome minimum = calibrate::calibrate_by_rqe(start, sample, measure, rqe);
  End end = refined(minimum.model, sample, settings);
  end.caveats.insert(end.caveats.begin(), minimum.caveats.begin(), minimum.caveats.end());
  add(end.caveats, minimum.unobservable);
  return end;
}

/// Even draws of λ, τ, α and η of each laser over the range, about the truth.
SensorModel drawn_start(const SensorModel& truth, const StartRange& range, std::uint64_t recording,
                        std::size_t number) {
  statistics::RandomStream random(recording, "start " + std::to_string(number));
  Eigen::VectorXd values = truth.values();
  for (std::size_t laser = 0; laser < truth.lasers(); ++laser) {
    const auto value = [&](estimate::BaseSlot which) -> double& {
      return values[static_cast<Eigen::Index>(estimate::slot(truth, laser, which))];
    };
    const double turn = random.uniform(-range.lambda, range.lambda);
    if (laser > 0) value(estimate::kLambda) += turn;
    value(estimate::kTau) = random.uniform(range.min_tau, range.max_tau);
    value(estimate::kAlpha) += random.uniform(-range.alpha, range.alpha);
    value(estimate::kEta) += random.uniform(-range.eta, range.eta);
  }
  SensorModel start = truth;
  start.set_values(values);
  return start;
}

/// All starts of one recording.
class Exploration {
 public:
  Exploration(const BasinSettings& settings, std::uint64_t seed, Measure& measure)
      : settings_(settings), measure_(measure), recording_(record(settings.trial, seed)), seed_(seed) {}

  BasinRecording run(std::size_t starts) {
    const SensorModel truth(recording_.simulated.truth);
    const estimate::Sample sample = recording_.sample();
    BasinRecording result{.seed = seed_, .parameters = {}, .starts = {}, .caveats = {}, .failure = {}};
    try {
      const End optimum = refined(truth, sample, settings_.trial);
      result.caveats = optimum.caveats;
      for (const std::size_t parameter : optimum.free) result.parameters.push_back(truth.names()[parameter]);
      for (std::size_t k = 0; k < starts; ++k) {
        result.starts.push_back(explore(drawn_start(truth, settings_.range, seed_, k), sample, optimum));
      }
    } catch (const Error& error) {
      result.failure = error.message();
    }
    return result;
  }

 private:
  BasinStart explore(const SensorModel& start, const estimate::Sample& sample, const End& optimum) {
    BasinStart result{.recording = seed_, .start = {}, .farthest = {}, .caveats = {}};
    const Eigen::VectorXd drawn = estimate::picked(start, optimum.free);
    result.start.assign(drawn.begin(), drawn.end());
    try {
      const End end = calibrated(start, sample, settings_.trial, measure_);
      result.caveats = end.caveats;
      compare(result, end, optimum);
    } catch (const Error& error) {
      result.caveats = {error.message()};
      result.off = std::numeric_limits<double>::infinity();
    }
    const bool same = result.off <= settings_.same;
    result.ending = same ? Ending::kSame : result.caveats.empty() ? Ending::kSilent : Ending::kWithCaveats;
    return result;
  }

  static void compare(BasinStart& result, const End& end, const End& optimum) {
    for (std::size_t k = 0; k < optimum.free.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(optimum.free[k]);
      const std::string& name = optimum.model.names()[optimum.free[k]];
      double error = end.model.values()[at] - optimum.model.values()[at];
      if (name.ends_with(".lambda")) error = std::remainder(error, 2 * std::numbers::pi);
      const double off = std::abs(error) / optimum.std_error[static_cast<Eigen::Index>(k)];
      if (off <= result.off) continue;
      result.off = off;
      result.farthest = name;
      result.error = error;
    }
  }

  const BasinSettings& settings_;
  Measure& measure_;
  TrialRecording recording_;
  std::uint64_t seed_;
};

}  // namespace

std::vector<BasinRecording> explore_basin(const BasinSettings& settings, const MakeMeasure& make_measure,
                                          const StudyHooks& hooks) {
  const std::size_t each = settings.starts_per_recording;
  return run_in_parallel<BasinRecording>(
      share_of(settings.part, settings.recordings()), settings.threads, hooks, [&](std::size_t k) {
        const auto measure = make_measure();
        const std::size_t recording = run_of(settings.part, k);
        return Exploration(settings, settings.first_seed + recording, *measure)
            .run(std::min(each, settings.starts - recording * each));
      });
}

}  // namespace crisp::study
