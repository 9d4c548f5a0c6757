// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <crisp/findings.hpp>
#include <crisp/measurements.hpp>
#include <crisp/points.hpp>

#include "plugins/diagnose/noise/noise_model.hpp"
#include "plugins/diagnose/scene/beam_association.hpp"

namespace crisp::diagnose {

/// Point density: number of points near a position, in 27 cells of 4 cm.
class PointDensity {
 public:
  explicit PointDensity(const PointsView& points);
  std::size_t about(double x, double y, double z) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const;
  };
  static Cell cell_of(double x, double y, double z);

  std::unordered_map<Cell, std::size_t, Hash> counts_;
};

/// One edge, a cell of half a metre: how often a laser's scans cross it, and with a mixed pixel.
struct Edge {
  double crossings = 0, mixed = 0;
  double share() const { return mixed / crossings; }
};

/// Edges that one laser's scans cross, from one flat surface to another one behind it.
struct Crossings {
  std::vector<bool> mixed;         ///< per crossing: whether a mixed pixel lies there
  std::vector<std::size_t> edges;  ///< per crossing: number of the edge
  std::vector<double> places;      ///< of the mixed pixels: 0 at the near side to 1 at the far side

  double share() const;  ///< of the crossings that are mixed
  std::vector<Edge> by_edge() const;
  /// Median over the edges, weighted by their crossings, of the share that is mixed. A wide beam mixes at all
  /// edges alike, clutter at those where it lies.
  double median_share() const;
};

/// Detects edge crossings: a beam that ends on a surface, up to three that end on none, one that ends on
/// another surface, at least 0.4 m apart in depth. A crossing is mixed if an intermediate range is a mixed
/// pixel: more than 12 cm from both surfaces, with hardly any other beam of the recording ending nearby.
/// Solid objects also put points between two surfaces, yet repeatedly at the same position. A crossing does
/// not count where the laser's noise could produce such a range, as in a spot of grazing incidence.
///
/// @param points  [m] end points of the beams
/// @param usual   [m] standard deviation of ranges, by usual_error()
/// @param noise   noise model of the laser
Crossings crossings_of(std::size_t laser, const Measurements& beams, const PointsView& points,
                       const BeamAssociation& association, const PointDensity& density, double usual,
                       const NoiseModel& noise);

/// Share of a laser's edge crossings that are mixed.
struct MixedShare {
  double value = 0;
  double std_error = 0;
  double degrees_of_freedom = 0;  ///< of the standard error; 0 with a single edge
};

/// Estimates the share with the standard error of a cluster sample, at least that of independent crossings.
/// The clusters are the edges: all scans that cross an edge meet the same surfaces there, such as the
/// narrow side of a box. The degrees of freedom are one less than the effective number of edges (Kish).
MixedShare mixed_share(std::span<const Edge> edges);

/// Tests whether a laser reports mixed pixels at edges (noise.mixed_pixels), at more than the 3 % of
/// crossings that thin objects explain, and at more than 3 % of those of the median edge.
///
/// @return  a finding that is significant at p < 0.002 by a t-test, with the share of mixed crossings
std::optional<Finding> mixed_pixels(const std::string& scope, const Crossings& crossings);

}  // namespace crisp::diagnose
