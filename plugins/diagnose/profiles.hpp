// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plugins/diagnose/distribution.hpp"
#include "plugins/diagnose/evidence.hpp"

namespace crisp {

/// In place of a laser: all of them.
inline constexpr std::size_t kAllLasers = ~std::size_t{0};

/// Residuals of one laser against one quantity, in bins of equally many beams. That of all lasers together
/// has a bin for each.
struct Profile {
  std::string covariate;
  std::string unit;       ///< of the covariate, SI; empty: it has none
  std::size_t laser = 0;  ///< or kAllLasers
  struct Bin {
    double at = 0;              ///< mean of the covariate, in SI
    double measured = 0;        ///< [m] mean residual, along the beam
    double simulated = 0;       ///< [m] of the scanner simulated in the scene that the data show
    double error = 0;           ///< [m] standard error of the mean
    std::size_t recording = 0;  ///< over time: which of several
  };
  std::vector<Bin> bins;  ///< over time: none has beams of two recordings
  double share = 0;       ///< of all residuals: those of the laser
  double rms = 0;         ///< [m] of the measured means, less what noise makes
  double p_value = 1;     ///< that noise makes as much in any of the profiles that were looked at

  /// Whether this is the simulation's by one chance in a hundred at most.
  bool departs() const { return p_value <= 0.01; }
};

/// The measured data beside what the model expects of them.
struct SideBySide {
  std::vector<Profile> profiles;
  std::vector<Distribution> distributions;  ///< of each laser
  std::vector<double> noise;  ///< [m] standard deviation of each laser's ranges that the residuals show
  double p_value = 1;         ///< that nothing but noise is in the residuals: the least of the profiles'
  double excess = 0;          ///< [m²] mean square of the residuals beyond what noise leaves of them

  /// [m²] Mean square, over all beams, of what departs from the simulation, over each covariate that shows
  /// it. What is off over one is off over others as well.
  ///
  /// @param laser  only of what departs in its ranges, or from laser to laser
  std::map<std::string, double> unexplained(std::optional<std::size_t> laser = {}) const;
};

/// Lays the residuals of the measured data beside those of the scanner simulated again, measurement by
/// measurement, in the scene that the data show: each beam where it meets its surface, with noise of the size
/// that its laser's residuals have. The simulation is repeated to see how far from nothing noise takes a
/// profile.
SideBySide side_by_side(const Evidence& evidence, const SurfelSettings& settings, std::uint64_t seed);

}  // namespace crisp
