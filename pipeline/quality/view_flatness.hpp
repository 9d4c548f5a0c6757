// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/quality/plane.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::quality {

/// The views of beams, numbered from 0.
struct ViewNumbers {
  explicit ViewNumbers(const BeamsView& beams);
  std::vector<std::uint32_t> of_beam;
  std::size_t count = 1;
};

/// Judges by itself what each view sees of a surface.
class ViewFlatness {
 public:
  ViewFlatness(const BeamsView& beams, const ViewNumbers& views, const SurfelSettings& settings)
      : beams_(beams), views_(views), settings_(settings), sums_(views.count) {}

  /// Whether these beams met something flat: of each view's distances from the common plane, a plane of the
  /// view's own is taken off, tilted by no more than some degrees; what is left, over all views, is no more
  /// than the noise of ranges makes, and max_excess.
  ///
  /// @param plane  of these beams, relative to the origin [m]
  bool is_flat(std::span<const std::uint32_t> members, const Plane& plane, const Eigen::Vector3d& origin);

 private:
  const BeamsView& beams_;
  const ViewNumbers& views_;
  const SurfelSettings& settings_;
  std::vector<ViewSums> sums_;  // of each view; empty but for those in use
  std::vector<std::uint32_t> in_use_;
};

}  // namespace crisp::quality
