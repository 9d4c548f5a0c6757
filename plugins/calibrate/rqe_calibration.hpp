// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/outcome.hpp"
#include "plugins/calibrate/in_plane_calibration.hpp"

namespace crisp::calibrate {

struct RqeCalibrationSettings {
  std::vector<std::string> fixed;  ///< parameters to be left alone: see free_parameters()
  InPlaneSettings in_plane;        ///< of the first calibration; its range holds for all of it
  bool full_field = true;          ///< whether the whole field of view follows, or that was all
  double sigma_from = 0.2;         ///< [m] kernel width over the full field at first
  double sigma_to = 0.05;          ///< [m] and at last
  std::size_t points = 60000;      ///< approximate number of beams of the full field that are used
  double noise = 0.012;            ///< [m] standard deviation of a range, for the standard errors
  std::size_t probes = 32;         ///< noisy copies of the data that the standard errors are taken from
  std::uint64_t seed = 1;
};

/// Receives progress: the fraction of the work so far, and the current activity.
using Reporter = std::function<void(double done, std::string_view what)>;

/// Estimates λ, τ, α and η by minimizing the RQE of the cloud of `sample`: first from the beams in the
/// plate's plane, in the paper's order, then from the whole field of view with σ narrowing.
///
/// The standard errors include the scatter by the ranges' noise. The optimum of a smooth entropy also has a
/// bias that they do not include; calibrate.refine removes it.
///
/// @param start   where to start; λ of all but the first laser may be anywhere
/// @param sample  all beams; need not be covered
/// @throws Error  if no parameter is free
estimate::Outcome calibrate_by_rqe(const SensorModel& start, const estimate::Sample& sample, Measure& measure,
                                   const RqeCalibrationSettings& settings, const Reporter& report = {});

}  // namespace crisp::calibrate
