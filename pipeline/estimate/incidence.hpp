// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// How each beam met its surface: |cos β| (see Measurements::cos_incidence), 1 for those on none.
std::vector<float> incidences(const quality::Surfels& surfels, const quality::BeamsView& beams);

}  // namespace crisp::estimate
