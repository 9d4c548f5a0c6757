// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <crisp/measure.hpp>

#include "grabbers/simulate/nominal_errors.hpp"
#include "grabbers/simulate/paper.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/calibrate/rqe_calibration.hpp"
#include "plugins/study/beam_choice.hpp"

namespace crisp::study {

/// The estimators of a recording.
enum class Estimators {
  kBoth,     ///< RQE from `start`, then the refinement from there, as by default
  kRefined,  ///< the refinement alone, from `near`: half the time, but no test of the basin
};

/// One calibration of a simulated recording; by default that of Sheehan, Harrison and Newman, section 5.2.
struct TrialSettings {
  simulate::Scene scene = simulate::paper_room();
  BeamChoice beams = BeamChoice::kInPlane;
  Rig rig = default_rig();
  std::size_t lasers = 3;                    ///< of the rig's, at least 1
  double duration = 10;                      ///< [s]
  simulate::MotionSettings motion;           ///< of the plate
  std::optional<std::uint64_t> motion_seed;  ///< the motion of all runs; none: each run draws its own
  double noise = 0.012;                      ///< [m] standard deviation of a range
  double quantum = 0.001;                    ///< [m] ranges are multiples of it
  std::vector<simulate::LaserEffects>
      laser_effects;                           ///< one a laser of the rig: noise of its own; empty: none
  std::optional<double> counted_noise;         ///< [m] that estimators and bound count on; none: `noise`
  double outliers = 0;                         ///< share of the ranges that are: see add_outliers()
  simulate::NominalErrors truth{.eta = 0.04};  ///< how far the truth lies off the rig at most
  Estimators estimators = Estimators::kBoth;
  simulate::NominalErrors start;  ///< how far off the start of RQE is at most; its η is 0
  simulate::NominalErrors
      near;  ///< how far off the refinement starts at most where RQE is left out: where RQE ends
  calibrate::RqeCalibrationSettings rqe;
  estimate::RefinementSettings refinement;

  TrialSettings();
};

/// @throws Error if the rig has fewer lasers than the trials want
void check_lasers(const TrialSettings& settings, const Rig& rig);

/// A simulated recording.
struct TrialRecording {
  simulate::SimulatedMeasurements simulated;
  Calibration start;
  estimate::Sample sample() const { return {.beams = simulated.beams, .plate = &simulated.plate}; }
};

/// True: the rig's nominal τ, α and λ, η drawn. The start is drawn around it.
TrialRecording record(const TrialSettings& settings, std::uint64_t seed);

/// Standard deviation [m] of the ranges of a recording, whatever the law of their noise: of their difference
/// from those of the same recording without noise.
double noise_in(const TrialSettings& settings, std::uint64_t seed);

/// One estimator's result for a recording.
struct Estimate {
  Eigen::VectorXd error;      ///< estimate − truth of each free parameter [SI]; λ within half a turn
  Eigen::VectorXd std_error;  ///< estimated by the calibration; empty if none
  std::string failure;        ///< why there is no estimate; empty otherwise
};

/// One run: a recording, and what the estimators make of it. The same seed gives the same, whichever runs
/// there are besides.
struct MonteCarloTrial {
  std::uint64_t seed = 0;
  std::vector<std::string> parameters;  ///< m: "laser1.tau", …
  Eigen::VectorXd bound;                ///< [SI] their Cramér–Rao bounds, see scene_bound()
  Eigen::VectorXd bound_with_steps;     ///< [SI] and where the steps of the encoder count as noise
  std::optional<Estimate> rqe;          ///< the paper's: the optimum of RQE
  Estimate refined;                     ///< the default: RQE, then least squares against flat surfaces
};

using MakeMeasure = std::function<std::unique_ptr<Measure>()>;
MonteCarloTrial run_trial(const TrialSettings& settings, std::uint64_t seed, const MakeMeasure& make_measure);

}  // namespace crisp::study
