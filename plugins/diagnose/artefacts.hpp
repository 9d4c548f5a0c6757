// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "pipeline/data/findings.hpp"
#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/sample.hpp"

namespace crisp {

/// Whether the plate was seen in a few directions again and again, and never between them, since its rate and
/// a mirror's are commensurate: what goes by its angle then shows at these directions alone, and the optimum
/// of an entropy shifts.
std::optional<Artefact> aliasing(const Sample& sample);

/// What the calibration that came differs by from the surfaces' own, where it is an entropy's optimum: that
/// shifts with the kernel's width and with how densely surfaces were sampled, which says nothing of the
/// scanner.
///
/// @param start  what came from above
/// @param plain  the same refined by surfaces, without further terms
std::optional<Artefact> density_bias(const Calibration& start, const Outcome& plain);

}  // namespace crisp
