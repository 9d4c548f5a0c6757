// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/data/measurements.hpp"
#include "pipeline/quality/points.hpp"
#include "plugins/diagnose/met.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// How many points lie about a place: those in 27 cells of 4 cm.
class Crowd {
 public:
  explicit Crowd(const PointsView& points);
  std::size_t about(double x, double y, double z) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const;
  };
  static Cell cell_of(double x, double y, double z);

  std::unordered_map<Cell, std::size_t, Hash> counts_;
};

/// The edges that one laser's scans cross: from one flat surface to another one behind it.
struct Crossings {
  std::vector<bool> mixed;     ///< of each: whether a range was reported there that ends on nothing
  std::vector<double> places;  ///< of those ranges: from 0, at the near side, to 1, at the far one

  double share() const;  ///< of all that are mixed
};

/// Looks for crossings: a beam that ends on a surface, up to three that end on none, one that ends on
/// another, 0.4 m or more apart in depth. A crossing is mixed if one of those between ends in thin air: more
/// than 12 cm from either side, where hardly any other beam of the recording ends. Bodies of some depth put
/// points between two surfaces, too, but again and again at the same place. Where the laser's own noise could
/// throw a range so far off either side, which a spot that grazes may do, a crossing does not count.
///
/// @param points  [m] where the beams end
/// @param usual   [m] standard deviation of ranges, by usual_error()
/// @param noise   of the laser
Crossings crossings_of(std::size_t laser, const Measurements& beams, const PointsView& points, const Met& met,
                       const Crowd& crowd, double usual, const NoiseLaw& noise);

/// Whether a laser reports ranges between what is before and behind an edge (noise.mixed_pixels), at more of
/// the edges than thin things explain, three in a hundred.
///
/// @return  what is significant beyond 0.002, with the share of the crossings that are mixed
std::optional<Finding> mixed_pixels(const std::string& scope, const Crossings& crossings, std::uint64_t seed);

}  // namespace crisp
