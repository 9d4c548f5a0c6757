// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <crisp/findings.hpp>

#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/sample.hpp"

namespace crisp::diagnose {

/// Detects aliasing of the plate angle: the plate's rate and the mirror's are commensurate, so scans sample a
/// few directions only. Effects of the plate angle then show in these directions alone, and the RQE optimum
/// shifts.
std::optional<EstimatorArtifact> aliasing(const estimate::Sample& sample);

/// Estimates the density bias of an entropy-based calibration: its difference from the surface-based
/// estimate. The RQE optimum shifts with the kernel width and with the sampling density of the surfaces,
/// independent of the scanner.
///
/// @param start  the incoming calibration
/// @param plain  the same, refined by surfaces without further terms
std::optional<EstimatorArtifact> density_bias(const Calibration& start, const estimate::Outcome& plain);

}  // namespace crisp::diagnose
