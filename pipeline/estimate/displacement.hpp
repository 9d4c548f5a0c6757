// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipeline/estimate/sample.hpp"

namespace crisp::estimate {

/// Mean square displacement [m²] of a sample's points by each pair of the free parameters (m × m), with rigid
/// motions of the whole cloud, which do not change RQE, projected out.
Eigen::MatrixXd displacement(const SensorModel& model, const Sample& sample,
                             const std::vector<std::size_t>& free);

}  // namespace crisp::estimate
