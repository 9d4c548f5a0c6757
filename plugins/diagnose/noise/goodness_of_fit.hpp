// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "plugins/diagnose/noise/noise_model.hpp"

namespace crisp::diagnose {

/// Type of the recording, which selects the test statistics.
enum class BeamsOf {
  kLaserAtRest,  ///< stationary laser: each block is a scan of the same spots, without errors of pose
  kSurfaces,     ///< beams on flat surfaces, where neighbours share errors
};

/// Goodness-of-fit test of a noise model by Monte Carlo simulation (parametric bootstrap). Each range becomes
/// the normal score of its probability under the model. The statistics are Pearson's χ² of the scores'
/// distribution, and the scores' spread over beam, range, incidence and remission. For a stationary laser
/// they are also spread and mean over time, mean over remission, and the correlations with the next scan and
/// the next beam. Their null distributions come from 99 simulations, with the model refitted to each and the
/// ranges quantized as reported.
///
/// @param all    errors about each beam's mean, as measured; large samples are reduced to some blocks
/// @param like   structure of the noise model; its parameters are fitted here
/// @param curve  [m] common-mode error by block; empty for none
data::FitStatistics goodness_of_noise_model(const RangeErrors& all, const NoiseModel& like,
                                            const Eigen::VectorXd& curve, BeamsOf beams, std::uint64_t seed);

/// Compares one laser's ranges with simulated ones of the normal noise model and of the identified noise
/// model.
///
/// @param named  the identified noise model, without the relative noise of beams, which is not simulated
/// @param curve  [m] identified common-mode error by block
data::GoodnessOfFit goodness_of_fit(const std::string& laser, const RangeErrors& errors,
                                    const NoiseModel& named, const Eigen::VectorXd& curve, BeamsOf beams,
                                    std::uint64_t seed);

}  // namespace crisp::diagnose
