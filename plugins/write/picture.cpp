// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

/// To the right, upwards, and towards the eye.
std::array<double, 3> seen(const Point& point, PictureView view) {
  const double x = static_cast<double>(point.x);
  const double y = static_cast<double>(point.y);
  const double z = static_cast<double>(point.z);
  switch (view) {
    case PictureView::top:
      return {x, y, z};
    case PictureView::front:
      return {x, z, -y};
    case PictureView::side:
      return {y, z, x};
  }
  return {x, y, z};
}

}  // namespace

PicturePainter::PicturePainter(const PictureSettings& settings)
    : settings_(settings), counts_(std::size_t{settings.width} * settings.height) {}

std::size_t PicturePainter::add(const Cloud& cloud) {
  const double pixels_per_metre = settings_.width / settings_.across;
  std::size_t drawn = 0;
  for (const Point& point : cloud) {
    const auto [right, up, depth] = seen(point, settings_.view);
    const double column = (right - settings_.centre[0]) * pixels_per_metre + settings_.width / 2.0;
    const double row = settings_.height / 2.0 - (up - settings_.centre[1]) * pixels_per_metre;
    const bool inside = column >= 0 && column < settings_.width && row >= 0 && row < settings_.height;
    if (!inside || !(depth >= settings_.depth[0] && depth <= settings_.depth[1])) continue;
    const auto pixel = static_cast<std::size_t>(row) * settings_.width + static_cast<std::size_t>(column);
    ++counts_[pixel][point.laser % 3U];
    ++drawn;
  }
  return drawn;
}

Picture PicturePainter::picture() const {
  // Blue, orange and green that together are nearly white; on black.
  constexpr std::array<std::array<double, 3>, 3> kColours = {
      {{0.25, 0.45, 1.0}, {1.0, 0.45, 0.1}, {0.2, 0.9, 0.35}}};
  constexpr double kFull = 4;  // points on a pixel for full brightness
  Picture picture{.width = settings_.width, .height = settings_.height, .rgb = {}};
  picture.rgb.reserve(counts_.size() * 3);
  for (const auto& counts : counts_) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      double light = 0;
      for (std::size_t laser = 0; laser < 3; ++laser) {
        light += kColours[laser][channel] * std::log1p(counts[laser]) / std::log1p(kFull);
      }
      picture.rgb.push_back(static_cast<std::uint8_t>(255 * std::min(1.0, light)));
    }
  }
  return picture;
}

std::string as_png(const Picture& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.width;
  image.height = picture.height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::string bytes;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, picture.rgb.data(), 0, nullptr) != 0) {
    bytes.resize(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) != 0) {
      bytes.resize(size);
      return bytes;
    }
  }
  throw Error(std::string("the picture cannot be encoded as PNG: ") +
              static_cast<const char*>(image.message));
}

}  // namespace crisp
