// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace crisp::data {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< [rad]

}  // namespace crisp::data
