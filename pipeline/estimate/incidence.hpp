// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// How each beam met its surface: |cos β| (see Measurements::cos_incidence), 1 for those on none.
std::vector<float> incidences(const Surfels& surfels, const BeamsView& beams);

}  // namespace crisp
