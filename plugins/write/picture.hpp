// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/data/cloud.hpp"

namespace crisp {

/// Viewing direction: along −z, along +y or along −x.
enum class PictureView { top, front, side };

struct PictureSettings {
  PictureView view = PictureView::top;
  std::array<double, 2> depth{-1e9, 1e9};  ///< [m] only points between these count, along the line of sight
  double across = 12;                      ///< [m] how much of the world is seen from edge to edge
  std::array<double, 2> centre{0, 0};      ///< [m] what is in the middle, in the picture's two directions
  std::uint32_t width = 800;               ///< pixels
  std::uint32_t height = 600;              ///< pixels
};

/// Rows from top to bottom, of pixels with 8 bits of red, green and blue each.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Collects points, and draws them in parallel projection: each laser in a colour of its own, the brighter
/// the more points of it fall on a pixel, so that where lasers disagree is seen as coloured seams.
class PicturePainter {
 public:
  explicit PicturePainter(const PictureSettings& settings);

  /// @return  how many of the points are in the picture
  std::size_t add(const Cloud& cloud);
  Picture picture() const;

 private:
  PictureSettings settings_;
  std::vector<std::array<std::uint32_t, 3>> counts_;  // of each pixel, by colour
};

/// The picture as a PNG file's bytes.
std::string as_png(const Picture& picture);

}  // namespace crisp
