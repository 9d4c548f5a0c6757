// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace crisp::write {

/// From above, along +y, along −x (all in parallel projection), or in perspective.
enum class PictureView { top, front, side, perspective };

/// What a point's colour stands for.
enum class PictureColour { laser, height, remission, time };

struct PictureSettings {
  PictureView view = PictureView::top;
  PictureColour colour = PictureColour::laser;
  std::array<double, 2> depth{-1e9, 1e9};       ///< [m] limits of z (top, perspective), y (front) or x (side)
  std::optional<double> across;                 ///< [m] width of the view; without it that of the points
  std::optional<std::array<double, 2>> centre;  ///< [m] to the right, upwards; without it the points' middle
  double azimuth = -1.05;      ///< [rad] of the eye seen from the centre, from +x towards +y: perspective
  double elevation = 0.6;      ///< [rad] of the eye above the plate's plane: perspective
  std::uint32_t width = 800;   ///< pixels
  std::uint32_t height = 600;  ///< pixels
};

}  // namespace crisp::write
