// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace crisp {

/// One curve, or points where `joined` is false.
struct PlotSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  bool joined = true;
};

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
};

/// The plot as an SVG picture of a few kilobytes, axes and names included. Points that are no numbers are
/// left out.
std::string as_svg(const Plot& plot);

}  // namespace crisp
