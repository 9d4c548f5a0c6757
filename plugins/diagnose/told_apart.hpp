// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/data/likeness.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

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
Likeness beside_law(const RangeErrors& all, const NoiseLaw& like, const Eigen::VectorXd& curve, BeamsOf beams,
                    std::uint64_t seed);

/// The ranges of one laser beside the plain simulator's, and beside those with what was found.
///
/// @param named  the law that was found: what is each beam's own has no name, and is not simulated
/// @param curve  [m] by block: what was found that all ranges do at once
ToldApart told_apart(const std::string& laser, const RangeErrors& errors, const NoiseLaw& named,
                     const Eigen::VectorXd& curve, BeamsOf beams, std::uint64_t seed);

}  // namespace crisp
