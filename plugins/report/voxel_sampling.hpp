// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/quality/spatial_order.hpp"

namespace crisp::report {

/// Thins points evenly over the surfaces that they lie on: voxel grid sampling with one cap on the points of
/// a cell, as large as `count` allows. Beams crowd near the scanner; each cell there keeps as many as the
/// others may, and cells with fewer points keep all of theirs. Within a cell, the kept points are spread
/// evenly along the curve.
///
/// @param order  n points along a Morton curve, with their cells
/// @return at most `count` indices of points, along the curve; all n where there are no more
std::vector<std::uint32_t> voxel_sample(const quality::SpatialOrder& order, std::size_t count);

}  // namespace crisp::report
