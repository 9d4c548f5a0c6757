// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/plot/plot.hpp"

namespace crisp::plot {

/// From a quantity to pixels, with marks at round values.
class PlotAxis {
 public:
  /// @param least, most  what is to be seen, above zero on a logarithmic axis
  PlotAxis(double least, double most, double first_pixel, double last_pixel,
           PlotScale scale = PlotScale::linear);
  /// Position of a value; values beyond are clipped to the axis's end.
  double pixel(double value) const;
  std::vector<double> marks() const;

 private:
  std::vector<double> round_values() const;
  std::vector<double> decades() const;

  PlotScale scale_;
  double least_ = 0, most_ = 1;  // of the value, or of its decimal logarithm
  double first_pixel_, last_pixel_;
};

/// The axes of a plot, along which all is seen that has a place there.
PlotAxis horizontal_axis(const Plot& plot, double first_pixel, double last_pixel);
PlotAxis vertical_axis(const Plot& plot, double first_pixel, double last_pixel);

/// Whether a point has a place in a plot.
bool is_shown(const Plot& plot, double x, double y);

/// Half the height of the bar at a point; 0: none.
double error_at(const PlotSeries& series, std::size_t i);

}  // namespace crisp::plot
