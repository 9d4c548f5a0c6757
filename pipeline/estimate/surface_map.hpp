// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <crisp/measurements.hpp>

#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// The flat surfaces that the beams of a recording meet, as one sensor model places them, with the noise of
/// the beams relative to one another. A refinement of a model near that one begins with them.
class SurfaceMap {
 public:
  /// @param beams  n of them, those of each laser in ascending time
  /// @param noise  n of them, or none where all are equal: see relative_noise()
  SurfaceMap(const Measurements& beams, quality::Surfels surfels, std::vector<float> noise);

  /// The same surfaces and noise in the numbering of other beams.
  struct Selection {
    quality::Surfels surfels;  ///< with those of their beams that are among the others, and their weights
    std::vector<float> noise;  ///< 1 where a beam is not of this map
  };
  /// @param beams  of the same recording, those of each laser in ascending time
  Selection of(const Measurements& beams) const;

 private:
  std::vector<double> time_;
  std::vector<std::uint16_t> laser_;
  quality::Surfels surfels_;
  std::vector<float> noise_;
};

}  // namespace crisp::estimate
