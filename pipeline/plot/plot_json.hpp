// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/plot/plot.hpp"

namespace crisp::plot {

/// The plot's data in one line of JSON, numbers with five digits: what a page that shows the picture draws it
/// from in another size. Keys: title, x_label, y_label, logarithmic, series (name, x, y, joined, error),
/// kinds (at, name), marks (at, around, name). What is no number is null.
std::string plot_json(const Plot& plot);

}  // namespace crisp::plot
