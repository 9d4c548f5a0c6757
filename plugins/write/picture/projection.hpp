// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "plugins/write/picture/points.hpp"
#include "plugins/write/picture/settings.hpp"

namespace crisp::write {

/// From points in the plate's frame to pixels.
class PictureProjection {
 public:
  /// What the settings leave open is taken from the points: the view then holds those between the 1st and the
  /// 99th percentile in both directions, with a margin, and is a round number wide.
  PictureProjection(const PictureSettings& settings, const std::vector<PicturePoint>& points);

  /// Column and row [pixels], from the upper left corner; nothing outside of the picture, of the limits of
  /// depth, or behind the eye.
  std::optional<std::array<std::uint32_t, 2>> pixel(const PicturePoint& point) const;

  double across() const {
    return across_;
  }  ///< [m] width of the picture (in perspective: at the centre's distance)
  const std::array<double, 2>& centre() const { return centre_; }  ///< [m] to the right, upwards

 private:
  std::array<double, 3> in_view(
      const PicturePoint& point) const;  // [m] to the right, upwards, towards the eye
  bool is_deep_enough(const PicturePoint& point) const;
  void fit(const std::vector<PicturePoint>& points);

  PictureSettings settings_;
  std::array<std::array<double, 3>, 3> axes_;  // right, up, towards the eye
  double across_ = 1;
  std::array<double, 2> centre_{0, 0};
  double distance_ = 0;  // [m] of the eye from the centre, in perspective
  double depth_ = 0;     // [m] of the centre towards the eye, in perspective
};

/// The smallest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below the value (> 0).
double round_above(double value);

}  // namespace crisp::write
