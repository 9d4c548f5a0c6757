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
  std::vector<double> error = {};  ///< half the height of a bar at each point; empty: no bars
};

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
};

/// The plots as one SVG picture, two in a row, with axes and names, a few kilobytes each. Points that are no
/// numbers are left out.
std::string as_svg(const std::vector<Plot>& plots);

}  // namespace crisp
