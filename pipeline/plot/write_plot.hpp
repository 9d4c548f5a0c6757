// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <crisp/context.hpp>

#include "pipeline/plot/plot.hpp"

namespace crisp::plot {

/// Writes plots into one SVG picture, and registers the file with the run.
/// @throws Error that names the file, if it cannot be written
void write_plots(const std::filesystem::path& file, const std::vector<Plot>& plots, Context& context);

}  // namespace crisp::plot
