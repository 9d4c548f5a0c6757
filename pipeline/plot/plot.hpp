// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace crisp::plot {

/// One curve, or points where `joined` is false. A curve breaks where x or y is no number.
struct PlotSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  bool joined = true;
  std::vector<double> error = {};  ///< half the height of a bar at each point; empty: no bars
};

/// One of several things that are no quantity, as a laser, or a side.
struct PlotKind {
  double at = 0;  ///< x of its points
  std::string name;
};

/// Something that was found on the horizontal axis.
struct PlotMark {
  double at = 0;
  double around = 0;  ///< half the width of a band; 0: none
  std::string name;
};

enum class PlotScale { linear, logarithmic };

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series = {};
  PlotScale y_scale = PlotScale::linear;  ///< logarithmic: what is not above zero is no number
  /// Categories on the horizontal axis instead of a quantity, at distances of 1: no points are joined then,
  /// and those of several series stand side by side.
  std::vector<PlotKind> kinds = {};
  std::vector<PlotMark> marks = {};
};

/// The plots as one SVG picture, two in a row, with axes, a few kilobytes each. The series' names are above
/// the frame, where they hide nothing. Each plot has its data with it, as plot_json() in a <metadata>
/// element.
std::string as_svg(const std::vector<Plot>& plots);

}  // namespace crisp::plot
