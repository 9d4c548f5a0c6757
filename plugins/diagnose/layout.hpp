// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "plugins/diagnose/profiles.hpp"

namespace crisp {

/// One profile's bins: which residuals are in each.
struct Layout {
  Profile profile;
  std::vector<std::uint32_t> residual;  ///< of the laser, in the order of the covariate
  std::vector<std::size_t> first;       ///< of each bin; one more than there are
};

/// Bins of about equally many of the laser's residuals; none has those of two recordings.
///
/// @param members    the laser's residuals
/// @param values     of these: the covariate
/// @param recording  which one a value is of; rises with it
Layout laid_out(const std::vector<std::uint32_t>& members, const std::vector<double>& values,
                const std::function<std::size_t(double value)>& recording);

}  // namespace crisp
