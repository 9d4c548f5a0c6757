// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "plugins/write/picture/painter.hpp"

namespace crisp::write {

/// Draws into the lower left corner a bar of a round length, at most a quarter of the picture wide, and its
/// length; in pictures of 120 pixels or more.
/// @param across  [m] width of the picture
void draw_scale_bar(Picture& picture, double across);

/// Draws into the lower right corner the colours from low to high, and these two values.
/// @param unit  "m", "s" or nothing
void draw_colour_scale(Picture& picture, double low, double high, const std::string& unit);

}  // namespace crisp::write
