// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp::test {

/// Oracle for line_by_convex_hull(): the same line as the solution of the linear program that maximizes the
/// line's height at `center` below all stamps (Moon, Skelly, Towsley: Estimation and removal of clock skew
/// from network delay measurements, INFOCOM 1999). It is solved in its dual, a concave function of the slope
/// alone, by cutting planes, without a hull.
clocks::ClockLine line_by_linear_program(std::span<const clocks::Stamp> stamps, double center);

}  // namespace crisp::test
