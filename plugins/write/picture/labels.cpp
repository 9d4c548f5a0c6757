// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "plugins/write/picture/colours.hpp"

namespace crisp::write {
namespace {

constexpr std::uint32_t kGlyphWidth = 5, kGlyphHeight = 7;

/// Rows of a character from top to bottom, 5 bits each. A font for sixteen characters is not worth a library
/// of fonts.
struct Glyph {
  char character;
  std::array<std::uint8_t, kGlyphHeight> rows;
};

constexpr std::array<Glyph, 16> kGlyphs{{
    {'0', {0b01110, 0b10001, 0b10011, 0b10101, 0b11001, 0b10001, 0b01110}},
    {'1', {0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}},
    {'2', {0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111}},
    {'3', {0b11110, 0b00001, 0b00001, 0b01110, 0b00001, 0b00001, 0b11110}},
    {'4', {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010}},
    {'5', {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110}},
    {'6', {0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110}},
    {'7', {0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000}},
    {'8', {0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110}},
    {'9', {0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100}},
    {'.', {0b00000, 0b00000, 0b00000, 0b00000, 0b00000, 0b01100, 0b01100}},
    {'-', {0b00000, 0b00000, 0b00000, 0b01110, 0b00000, 0b00000, 0b00000}},
    {'e', {0b00000, 0b00000, 0b01110, 0b10001, 0b11111, 0b10000, 0b01110}},
    {'m', {0b00000, 0b00000, 0b11010, 0b10101, 0b10101, 0b10101, 0b10101}},
    {'s', {0b00000, 0b00000, 0b01111, 0b10000, 0b01110, 0b00001, 0b11110}},
    {'+', {0b00000, 0b00100, 0b00100, 0b11111, 0b00100, 0b00100, 0b00000}},
}};

constexpr PictureRgb kWhite{255, 255, 255};

/// Fills a rectangle of pixels, as far as it is in the picture.
void fill(Picture& picture, std::uint32_t left, std::uint32_t top, std::uint32_t width, std::uint32_t height,
          const PictureRgb& colour) {
  for (std::uint32_t row = top; row < std::min(picture.height, top + height); ++row) {
    for (std::uint32_t column = left; column < std::min(picture.width, left + width); ++column) {
      std::ranges::copy(
          colour, picture.rgb.begin() + std::ptrdiff_t{3} * (std::ptrdiff_t{row} * picture.width + column));
    }
  }
}

/// Pixels of the picture that a pixel of the font takes in each direction.
std::uint32_t size_of_dot(const Picture& picture) {
  return std::max(1U, std::min(picture.width, picture.height) / 300);
}

std::uint32_t width_of(const std::string& text, std::uint32_t dot) {
  return static_cast<std::uint32_t>(text.size()) * (kGlyphWidth + 1) * dot;
}

void write_text(Picture& picture, std::uint32_t left, std::uint32_t top, const std::string& text) {
  const std::uint32_t dot = size_of_dot(picture);
  for (const char character : text) {
    const auto* const glyph = std::ranges::find(kGlyphs, character, &Glyph::character);
    for (std::uint32_t row = 0; glyph != kGlyphs.end() && row < kGlyphHeight; ++row) {
      for (std::uint32_t column = 0; column < kGlyphWidth; ++column) {
        const bool is_set = (glyph->rows[row] >> (kGlyphWidth - 1 - column) & 1U) != 0;
        if (is_set) fill(picture, left + column * dot, top + row * dot, dot, dot, kWhite);
      }
    }
    left += (kGlyphWidth + 1) * dot;
  }
}

constexpr std::uint32_t kMinSize = 120;  // pixels of a picture that has room for labels

bool has_room(const Picture& picture) { return std::min(picture.width, picture.height) >= kMinSize; }

/// The largest of 1, 2, 5 times a power of ten that is not above the value.
double round_below(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade <= value) return step * decade;
  }
  return decade;
}

std::string with_unit(double value, const std::string& unit) {
  const std::string number = fmt::format("{:.3g}", value);
  return unit.empty() ? number : number + " " + unit;
}

}  // namespace

void draw_scale_bar(Picture& picture, double across) {
  if (!has_room(picture)) return;
  const double length = round_below(across / 4);
  const std::uint32_t dot = size_of_dot(picture), left = 8 * dot, bottom = picture.height - 8 * dot;
  const auto width = static_cast<std::uint32_t>(std::lround(length / across * picture.width));
  const bool is_short = length < 0.1;
  write_text(picture, left, bottom - 12 * dot,
             is_short ? with_unit(1e3 * length, "mm") : with_unit(length, "m"));
  fill(picture, left, bottom - 2 * dot, width, 2 * dot, kWhite);
}

void draw_colour_scale(Picture& picture, double low, double high, const std::string& unit) {
  if (!has_room(picture)) return;
  const std::uint32_t dot = size_of_dot(picture), width = picture.width / 4,
                      bottom = picture.height - 8 * dot;
  const std::uint32_t left = picture.width - 8 * dot - width;
  for (std::uint32_t column = 0; column < width; ++column) {
    fill(picture, left + column, bottom - 4 * dot, 1, 4 * dot,
         ramp_colour(static_cast<double>(column) / (width - 1)));
  }
  const std::string first = with_unit(low, unit), last = with_unit(high, unit);
  write_text(picture, left, bottom - 14 * dot, first);
  write_text(picture, left + width - std::min(width, width_of(last, dot)), bottom - 14 * dot, last);
}

}  // namespace crisp::write
