// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plugins/diagnose/model/residual_histogram.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"

namespace crisp::diagnose {

/// Stands for all lasers in place of one.
inline constexpr std::size_t kAllLasers = ~std::size_t{0};

/// Mean residual of one laser against one covariate, in quantile bins. The profile of all lasers has one bin
/// per laser.
struct Profile {
  std::string covariate;
  std::string unit;       ///< SI unit of the covariate; empty if dimensionless
  std::size_t laser = 0;  ///< or kAllLasers
  struct Bin {
    double at = 0;              ///< mean of the covariate, in SI units
    double measured = 0;        ///< [m] mean residual, along the beam
    double simulated = 0;       ///< [m] mean residual of the scanner simulated in the estimated scene
    double error = 0;           ///< [m] standard error of the mean
    std::size_t recording = 0;  ///< for the covariate time: number of the recording
  };
  std::vector<Bin> bins;   ///< for the covariate time, no bin has beams of two recordings
  double share = 0;        ///< the laser's share of all residuals
  double rms = 0;          ///< [m] of the measured means, less the contribution of noise
  double p_value = 1;      ///< that noise alone makes any of the tested profiles this large
  bool is_shadow = false;  ///< what deviates is another profile's deviation: see mark_shadows()
  bool is_common = false;  ///< all lasers deviate over this covariate: see mark_shadows()

  /// Whether the profile deviates significantly from the simulation (p ≤ 1 %).
  bool is_significant() const { return p_value <= 0.01; }
};

/// Residuals of the measured data compared with those of the simulated scanner.
struct ProfileComparison {
  std::vector<Profile> profiles;
  std::vector<Distribution> distributions;  ///< per laser
  std::vector<double> noise;  ///< [m] standard deviation of each laser's ranges, estimated from the residuals
  double p_value = 1;         ///< that the residuals are noise alone: the smallest of the profiles
  double excess = 0;          ///< [m²] mean square of the residuals beyond the expectation for noise

  /// [m²] Mean square of the systematic residual over all beams, by covariate. One deviation may show over
  /// several covariates.
  ///
  /// @param laser  restricts it to deviations of this laser's ranges, and to deviations between lasers
  std::map<std::string, double> unexplained(std::optional<std::size_t> laser = {}) const;
};

/// Compares the residual profiles with a parametric bootstrap: the scanner is simulated in the estimated
/// scene, each beam on its own surface, with its laser's estimated noise. Repeated simulations give the
/// distribution of each profile under the null hypothesis.
ProfileComparison compare_with_simulation(const SurfaceObservations& observations,
                                          const quality::SurfelSettings& settings, std::uint64_t seed);

}  // namespace crisp::diagnose
