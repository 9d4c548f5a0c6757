// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace crisp::write {

using PictureRgb = std::array<std::uint8_t, 3>;

/// As on the report's page (plugins/report/page/colours.js): of Okabe and Ito, distinguishable by
/// colour-blind people, too; then from the first again.
inline constexpr std::array<PictureRgb, 7> kLaserColours{{{86, 180, 233},
                                                          {230, 159, 0},
                                                          {0, 200, 140},
                                                          {240, 228, 66},
                                                          {204, 121, 167},
                                                          {213, 94, 0},
                                                          {60, 110, 230}}};

/// Viridis, as on the report's page.
inline constexpr std::array<PictureRgb, 9> kRamp{{{68, 1, 84},
                                                  {71, 44, 122},
                                                  {59, 81, 139},
                                                  {44, 113, 142},
                                                  {33, 144, 141},
                                                  {39, 173, 129},
                                                  {92, 200, 99},
                                                  {170, 220, 50},
                                                  {253, 231, 37}}};

/// @param share  0 to 1 along the ramp; what lies beyond has the colour of its end
PictureRgb ramp_colour(double share);

}  // namespace crisp::write
