// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plugins/write/picture/points.hpp"
#include "plugins/write/picture/settings.hpp"

namespace crisp::write {

/// Rows from top to bottom, of pixels with 8 bits of red, green and blue each.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgb;
  std::size_t drawn = 0;  ///< how many of the points are in it
};

/// Draws points on black, with a bar for the scale. Coloured by laser, a pixel's light is the sum of all
/// lasers' that hit it, each the brighter the more points it has there: where lasers disagree there are
/// coloured seams. Coloured by a value, a pixel has the colour of the mean, between the 1st and the 99th
/// percentile of all.
Picture paint(const PicturePoints& points, const PictureSettings& settings);

/// The picture as a PNG file's bytes.
std::string as_png(const Picture& picture);

}  // namespace crisp::write
