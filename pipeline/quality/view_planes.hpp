// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pipeline/quality/plane.hpp"

namespace crisp::quality {

/// The plane in which each view by itself sees a piece of a surface.
class ViewPlanes {
 public:
  /// @param weight  [1/m²] of the beam's noise across the surface
  void add(std::uint32_t view, const Eigen::Vector3d& point, double weight);
  ViewPlanes& operator+=(const ViewPlanes& other);

  /// Whether the views that see both pieces see them in one plane: a common plane of each view fits no worse
  /// than two, but for chance and bumps.
  ///
  /// @param plane  of the surface, from which a view's own plane is tilted by no more than some degrees
  /// @param bump   [standard deviations of the noise across]
  bool continues(const ViewPlanes& other, const Plane& plane, double bump) const;

 private:
  struct OfView {
    std::uint32_t view = 0;
    double beams = 0;
    Moments moments;  // weighted
  };
  OfView& of(std::uint32_t view);

  std::vector<OfView> views_;  // ascending
};

}  // namespace crisp::quality
