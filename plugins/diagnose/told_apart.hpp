// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// One way in which measured ranges may differ from simulated ones.
struct RangeLook {
  std::string covariate;  ///< "beam"
  std::string quantity;   ///< "noise": how much they scatter; "range": their mean; "density"; "correlation"
  std::string unit;       ///< of the amplitude
  double amplitude = 0;   ///< RMS over the covariate, less what chance makes
  double p_value = 1;     ///< that chance makes as much in any of the looks
};

/// How one laser's measured ranges lie beside those that a law makes.
struct BesideLaw {
  std::vector<RangeLook> looks;
  double p_value = 1;  ///< that they are of the law: the least of the looks'
};

/// What is looked at beside the law itself.
enum class BeamsOf {
  kLaserAtRest,  ///< that meet the same spots in each block, a scan, without any error but the laser's own
  kSurfaces,     ///< on flat surfaces, whose errors neighbours share
};

/// Simulates a laser's ranges by a law, measurement by measurement, and asks whether the measured ones can be
/// told from them. Each is turned into the normal score that the law gives it. Of these the distribution is
/// looked at (Pearson's χ²), the spread over beam, range, incidence and remission, and for a laser at rest
/// spread and mean over the scans, the mean over remission, and the correlation with the next scan and the
/// next beam. How far chance takes each is seen in 99 simulations, to which the law is fitted anew as it was
/// to the measured ranges; telegrams' steps are made as well.
///
/// @param all    about the mean of their beams, as they were measured; of very many, some blocks count
/// @param like   which parts the law has; it is fitted here
/// @param curve  [m] by block: what all ranges do at once; empty for nothing
BesideLaw beside_law(const RangeErrors& all, const NoiseLaw& like, const Eigen::VectorXd& curve,
                     BeamsOf beams, std::uint64_t seed);

/// The ranges of one laser beside the plain simulator's, and beside those with what was found.
struct ToldApart {
  std::string laser;
  BesideLaw before, after;
};

/// @param named  the law that was found: what is each beam's own has no name, and is not simulated
/// @param curve  [m] by block: what was found that all ranges do at once
ToldApart told_apart(const std::string& laser, const RangeErrors& errors, const NoiseLaw& named,
                     const Eigen::VectorXd& curve, BeamsOf beams, std::uint64_t seed);

/// Says of all lasers together whether they can be told from the simulated ones, and which do by what.
void add_likeness(const std::vector<ToldApart>& lasers, Findings& to);

}  // namespace crisp
