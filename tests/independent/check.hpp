// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace independent {

/// Reads a folder's capture back, places its beams by the truth, and compares their ranges with the scene's.
///
/// Equation (2) is evaluated as its chain of matrices here, where the simulator uses vectors on paper.
/// @return whether each laser's robust residual sd is within 10 % (plus 1 mm) of its range noise
bool check(const std::string& folder);

}  // namespace independent
