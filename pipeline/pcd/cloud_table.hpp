// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "pipeline/data/cloud.hpp"
#include "pipeline/pcd/pcd_table.hpp"

namespace crisp {

/// A cloud as a PCD table: fields x y z intensity laser beam time, and the note epoch_ns, all exactly.
PcdTable to_table(const Cloud& cloud);

struct TableCloud {
  std::shared_ptr<Cloud> cloud;
  std::size_t not_finite = 0;  ///< points without a position or time that is a number: left out
};

/// The cloud that a PCD file of any origin holds. Only x, y and z must be there; what else is not, is 0.
/// @throws Error if they are not, or a laser or beam is beyond 65535
TableCloud cloud_of(const PcdTable& table);

}  // namespace crisp
