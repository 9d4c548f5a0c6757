// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <crisp/cloud.hpp>

#include "plugins/write/picture/settings.hpp"

namespace crisp::write {

/// A point to draw, in the plate's frame.
struct PicturePoint {
  float x = 0, y = 0, z = 0;  ///< [m]
  float value = 0;  ///< what its colour shows: height [m], remission, or time [s] since the first point
  std::uint16_t laser = 0;
};

/// Points of any number of clouds in bounded memory: when `most` are kept, every second one goes, and from
/// then on every second one comes.
class PicturePoints {
 public:
  explicit PicturePoints(PictureColour colour, std::size_t most = 4'000'000);

  void add(const Cloud& cloud);
  const std::vector<PicturePoint>& kept() const { return kept_; }
  std::uint64_t one_in() const { return one_in_; }  ///< how many points each one that is kept stands for

 private:
  float value_of(const Point& point, std::uint64_t epoch);

  PictureColour colour_;
  std::size_t most_;
  std::vector<PicturePoint> kept_;
  std::uint64_t one_in_ = 1, seen_ = 0;
  std::optional<double> first_;  // [s since the Unix epoch] of the first point
};

}  // namespace crisp::write
