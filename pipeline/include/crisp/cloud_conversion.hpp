// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <crisp/cloud.hpp>
#include <crisp/pcd_table.hpp>

namespace crisp {

/// A cloud as a PCD table: fields x y z intensity laser beam time, and the note epoch_ns, all exactly.
PcdTable to_pcd_table(const Cloud& cloud);

/// A cloud that was made of a PCD table, and what it could not keep.
struct ConvertedCloud {
  std::shared_ptr<Cloud> cloud;  ///< the points, in the order of the table
  std::size_t not_finite = 0;    ///< points without a position or time that is a number: left out
  double rounding = 0;  ///< [m] most that a coordinate changed when it became single, as those of a Cloud are
};

/// The cloud that a PCD file of any origin holds. Only x, y and z must be there; what else is not, is 0.
/// @param shift  [m] subtracted from all coordinates before they become single
/// @throws Error if they are not, or a laser or beam is beyond 65535
ConvertedCloud cloud_of(const PcdTable& table, const std::array<double, 3>& shift = {});

/// Content of the file that a cloud does not hold, and that is lost: "the fields rgb, normal_x", "the
/// VIEWPOINT". Empty if there is none.
std::vector<std::string> dropped_fields(const PcdTable& table);

/// Suggested offset that moves the first point close to the origin, in whole 100 m [m].
std::array<double, 3> suggested_shift(const PcdTable& table);

}  // namespace crisp
