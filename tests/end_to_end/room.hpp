// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <filesystem>
#include <vector>

#include <crisp/cloud.hpp>

namespace crisp::test {

/// Writes the scene that the tests know by heart: an empty room of 6 x 5 x 3 m with the scanner at (2.3, 2.1,
/// 1.2) m in it, turned by 0.3 rad. Returns the file.
std::filesystem::path write_room(const std::filesystem::path& file);

/// One point against the room.
struct Residual {
  int wall = 0;          ///< 0, 1: x = 0, 6; 2, 3: y = 0, 5; 4, 5: z = 0, 3
  double distance = 0;   ///< [m] from it, positive within the room
  double incidence = 1;  ///< cosine of the angle between the beam and the wall's normal
};

/// Each point's distance to the wall that it must be of, and the incidence of its beam. Points near an edge,
/// which may be of either wall, are left out.
/// @param tau  [m] distance of each laser from the axis, from which the beam's direction follows
std::vector<Residual> against_room(const Cloud& cloud, const std::vector<double>& tau);

/// Root of the mean square of what `of` gives of each residual.
template <class Of>
double rms(const std::vector<Residual>& residuals, Of of) {
  double sum = 0;
  for (const auto& residual : residuals) sum += of(residual) * of(residual);
  return std::sqrt(sum / static_cast<double>(residuals.size()));
}

}  // namespace crisp::test
