// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <crisp/points.hpp>

namespace crisp::quality {

/// n beams that met something.
struct BeamsView {
  PointsView points;      ///< [m] where
  PointsView directions;  ///< unit vectors from the laser to there
  /// Which view each is of. Beams of one view disagree by little but noise, however wrong the calibration is:
  /// one laser, one half of its sweep. None: all are of one.
  std::span<const std::uint32_t> views;
  /// Relative noise of each range, in units of SurfelSettings::noise. None: all 1.
  std::span<const float> noise = {};

  double noise_of(std::size_t beam) const { return noise.empty() ? 1.0 : double{noise[beam]}; }
};

struct SurfelSettings {
  double smallest = 0.25;       ///< [m] side of the cells that a surface must fill
  double largest = 4;           ///< [m] side of the cells that are tried first
  double noise = 0.012;         ///< [m] standard deviation of a range
  double floor = 0.002;         ///< [m] least standard deviation across a surface, however flat it is met
  double max_thickness = 0.15;  ///< [m] RMS distance from the common plane, up to which views may disagree
  double max_excess = 1;     ///< by which the variance within views may exceed that of the noise, relatively
  double max_tilt = 0.05;    ///< [rad] between neighbouring pieces of one surface
  double max_offset = 0.03;  ///< [m] between neighbouring pieces of one surface
  /// [standard deviations of the noise across] by which views may see neighbouring pieces in different
  /// planes. Only a calibration that is nearly right makes each view's own surfaces flat; infinite: they are
  /// not compared.
  double max_bump = std::numeric_limits<double>::infinity();
  std::uint32_t min_points = 20;  ///< of a surfel
  double outlier = 4.7;  ///< [σ] distance from which a beam no longer counts (Tukey's biweight); 0: all do
};

/// A piece of a plane, and the beams that met it.
struct Surfel {
  Eigen::Vector3d middle;   ///< [m] a point of the plane
  Eigen::Vector3d normal;   ///< towards the lasers
  Eigen::Vector3d u, v;     ///< unit vectors in the plane
  double radius = 0;        ///< [m] RMS distance of its points from the middle
  double thickness = 0;     ///< [m] RMS distance of its points from the plane
  std::uint32_t begin = 0;  ///< its beams are members[begin] … members[end − 1]
  std::uint32_t end = 0;
};

struct Surfels {
  std::vector<Surfel> surfels;         ///< the largest first
  std::vector<std::uint32_t> members;  ///< beams, in ascending order within each surfel
  std::vector<double> weights;         ///< 0 to 1, of each member: how much it counts

  /// Adds a surfel with its beams, all of which count in full.
  void add(Surfel surfel, std::span<const std::uint32_t> beams);
  std::span<const std::uint32_t> beams_of(const Surfel& surfel) const {
    return std::span(members).subspan(surfel.begin, surfel.end - surfel.begin);
  }
};

/// Systematic subsample of each surface's beams, with at most about `most` in total.
Surfels thinned(const Surfels& surfels, std::size_t most);

/// Finds flat surfaces. Cells are tried from large to small. Whether one is flat is decided on shape, never
/// on how well views agree, for that is what is to be judged by the surfels: each view is compared with a
/// plane of its own, and the common plane may be as thick as max_thickness. Flat cells of one surface are
/// joined, so that surfels grow to whole walls, and a surfel takes all beams that end near its plane where
/// its cells are, in which cell they may lie themselves: surfaces that coincide with a boundary of cells are
/// not split.
///
/// @throws Error  for points or directions that are no numbers, lengths that differ, or settings out of range
/// The result is the same on any number of threads.
Surfels find_surfels(const BeamsView& beams, const SurfelSettings& settings);

/// Leaves out surfels whose beams miss their plane by far more than those of most surfels do, in units of
/// what noise explains. A wrong calibration makes views disagree on all surfaces; those that do much worse
/// are edges, or two sides of something thin.
///
/// @param times  so many times as much as most, and what chance makes of so few beams
void reject_inconsistent(Surfels& found, const BeamsView& beams, const SurfelSettings& settings,
                         double times);

/// Leaves out surfels that their beams graze, at less than 12° on average. Behind an edge, beams that end
/// between it and the background (mixed pixels) form veils, which contain the beams. Across a veil the
/// ranges' noise is next to nothing, so that a thousand of its beams would outweigh all walls.
void reject_grazed(Surfels& found, const BeamsView& beams);

}  // namespace crisp::quality
