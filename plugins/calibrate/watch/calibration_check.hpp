// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <crisp/rig.hpp>

#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::calibrate {

/// Parameters that a recalibration estimates.
enum class RecalibratedParameters : std::uint8_t {
  Lags,  ///< η alone, which differs from one start of the devices to the next
  All,   ///< the geometry as well
};

/// Whether it is found anew.
enum class RecalibrationPolicy : std::uint8_t { No, IfStale, Yes };

struct CheckSettings {
  double sigma = 0.03;          ///< [m] kernel width of the RQE that compares
  double tolerance = 0.003;     ///< [nat] by which a calibration may be less crisp than the best one
  double significance = 5;      ///< [standard errors] by which a parameter must have moved as well
  std::size_t beams = 100'000;  ///< number of beams in a check
  RecalibratedParameters parameters = RecalibratedParameters::Lags;
  estimate::RefinementSettings refinement;
};

/// A calibration that was found anew.
struct Recalibration {
  Calibration calibration;
  double rqe = 0;                    ///< of the same points under it
  std::vector<std::string> caveats;  ///< why it may not be the truth
};

/// How good a calibration is for what was measured just now.
struct CalibrationCheck {
  double rqe = 0;       ///< of the cloud under the calibration: lower is better
  double best_rqe = 0;  ///< of the same points under the calibration that fits them best
  bool stale = false;   ///< whether the calibration no longer describes the scanner
  /// The parameter that would move most, in words: "laser2.alpha by 0.4 deg (12 standard errors)".
  std::string moved = {};
  std::optional<Recalibration> recalibration = {};  ///< if it was wanted
};

/// Refines a calibration by the surfaces that the beams show, and compares the RQE of the same points under
/// both. A scene's own entropy is no criterion, since it changes as the scanner moves; its decrease for the
/// same points by another calibration is one. The calibration is stale where it decreases by more than
/// `tolerance`, and a parameter has moved by more than `significance` of its standard errors.
///
/// @param keep_running  polled between the rounds of the work
/// @throws Error  if the beams show no flat surface
CalibrationCheck check_calibration(const Calibration& calibration, const estimate::Sample& sample,
                                   const Rig& rig, const TermRegistry& terms, const CheckSettings& settings,
                                   RecalibrationPolicy policy, const std::function<bool()>& keep_running);

}  // namespace crisp::calibrate
