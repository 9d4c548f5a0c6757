// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <crisp/calibration.hpp>

namespace crisp {

const LaserCalibration* Calibration::find(const std::string& laser) const {
  const auto found =
      std::find_if(lasers.begin(), lasers.end(), [&](const auto& l) { return l.name == laser; });
  return found == lasers.end() ? nullptr : &*found;
}

}  // namespace crisp
