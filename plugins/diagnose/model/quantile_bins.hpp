// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "plugins/diagnose/model/residual_profiles.hpp"

namespace crisp::diagnose {

/// The bins of one profile with their residuals.
struct QuantileBins {
  Profile profile;
  std::vector<std::uint32_t> residual;  ///< residuals of the laser, sorted by the covariate
  std::vector<std::size_t> first;       ///< first residual of each bin; one more than there are
};

/// Quantile bins: about equally many of the laser's residuals in each, never those of two recordings.
///
/// @param members    the laser's residuals
/// @param values     the covariate of each
/// @param recording  number of the recording that a value belongs to; monotonic in the value
QuantileBins quantile_bins(const std::vector<std::uint32_t>& members, const std::vector<double>& values,
                           const std::function<std::size_t(double value)>& recording);

}  // namespace crisp::diagnose
