// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/distribution.hpp"

namespace crisp {

/// The density of one laser's residuals in units of their noise, with bars of two standard errors either way:
/// measured, what is simulated in its place, and measured with the extended model.
///
/// @param after  null, or the same as `before`, where nothing was found: it is left out then
Plot distribution_plot(const std::string& name, const Distribution& before, const Distribution* after);

}  // namespace crisp
