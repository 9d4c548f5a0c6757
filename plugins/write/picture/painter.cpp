// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/painter.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <crisp/error.hpp>

#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/write/picture/colours.hpp"
#include "plugins/write/picture/labels.hpp"
#include "plugins/write/picture/projection.hpp"

namespace crisp::write {
namespace {

/// 0 to 1: full for four points in a pixel.
double brightness(double points) { return std::min(1.0, std::log1p(points) / std::log1p(4)); }

void put(Picture& picture, std::size_t pixel, const std::array<double, 3>& light) {
  for (std::size_t k = 0; k < 3; ++k) {
    picture.rgb[3 * pixel + k] = static_cast<std::uint8_t>(std::min(255.0, light[k]));
  }
}

/// Calls visit(pixel, point) for each point in the picture.
template <class Visit>
void draw_each(Picture& picture, const PicturePoints& points, const PictureProjection& projection,
               Visit visit) {
  for (const PicturePoint& point : points.kept()) {
    const auto at = projection.pixel(point);
    if (!at) continue;
    visit(std::size_t{(*at)[1]} * picture.width + (*at)[0], point);
    picture.drawn += points.one_in();
  }
}

void paint_lasers(Picture& picture, const PicturePoints& points, const PictureProjection& projection) {
  constexpr std::size_t kColours = kLaserColours.size();
  std::vector<std::array<std::uint32_t, kColours>> counts(picture.rgb.size() / 3);
  draw_each(picture, points, projection,
            [&](std::size_t pixel, const PicturePoint& point) { ++counts[pixel][point.laser % kColours]; });
  for (std::size_t pixel = 0; pixel < counts.size(); ++pixel) {
    std::array<double, 3> light{};
    for (std::size_t laser = 0; laser < kColours; ++laser) {
      const double strength = brightness(static_cast<double>(counts[pixel][laser] * points.one_in()));
      for (std::size_t k = 0; k < 3; ++k) light[k] += strength * kLaserColours[laser][k];
    }
    put(picture, pixel, light);
  }
}

/// Those values between which 98 % of what is in the picture lie.
std::array<double, 2> limits_of(const PicturePoints& points, const PictureProjection& projection) {
  std::vector<float> values;
  for (const PicturePoint& point : points.kept()) {
    if (std::isfinite(point.value) && projection.pixel(point)) values.push_back(point.value);
  }
  if (values.empty()) return {0, 1};
  const double low{statistics::quantile_in_place(values, 0.01)};
  return {low, std::max(double{statistics::quantile_in_place(values, 0.99)}, low + 1e-9)};
}

void paint_values(Picture& picture, const PicturePoints& points, const PictureProjection& projection,
                  const std::array<double, 2>& limits) {
  constexpr double kMinLight = 0.8;  // so that the darkest colour differs from the ground
  struct Sum {
    double value = 0;
    std::uint32_t count = 0;
  };
  std::vector<Sum> sums(picture.rgb.size() / 3);
  draw_each(picture, points, projection, [&](std::size_t pixel, const PicturePoint& point) {
    if (!std::isfinite(point.value)) return;
    sums[pixel].value += double{point.value};
    ++sums[pixel].count;
  });
  for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
    const auto& [sum, count] = sums[pixel];
    if (count == 0) continue;
    const PictureRgb colour = ramp_colour((sum / count - limits[0]) / (limits[1] - limits[0]));
    const double light = std::max(kMinLight, brightness(static_cast<double>(count * points.one_in())));
    put(picture, pixel, {light * colour[0], light * colour[1], light * colour[2]});
  }
}

}  // namespace

Picture paint(const PicturePoints& points, const PictureSettings& settings) {
  const PictureProjection projection(settings, points.kept());
  Picture picture{.width = settings.width, .height = settings.height, .rgb = {}};
  picture.rgb.resize(std::size_t{3} * settings.width * settings.height);
  if (settings.colour == PictureColour::laser) {
    paint_lasers(picture, points, projection);
  } else {
    const auto limits = limits_of(points, projection);
    paint_values(picture, points, projection, limits);
    const bool is_height = settings.colour == PictureColour::height,
               is_time = settings.colour == PictureColour::time;
    draw_colour_scale(picture, limits[0], limits[1], is_height ? "m" : is_time ? "s" : "");
  }
  draw_scale_bar(picture, projection.across());
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
  throw Error(std::string("the picture cannot be encoded as PNG: ") + static_cast<const char*>(image.message),
              "reduce width and height");
}

}  // namespace crisp::write
