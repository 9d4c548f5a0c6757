// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <crisp/rig.hpp>

#include "pipeline/estimate/sample.hpp"

namespace crisp::calibrate {

/// A possible correction of one laser's entry in the rig.
struct LaserChange {
  double mount_turn = 0;        ///< [rad] by which its mount is greater
  bool is_upside_down = false;  ///< compared with the rig: its angles grow the other way
  bool operator==(const LaserChange&) const = default;
};

/// A possible correction of a rig, as it changes what the measurements mean.
struct RigChange {
  std::string words;  ///< "plate.direction: clockwise"
  double turn = 1;    ///< by which the plate's angles are multiplied; −1: it counts the other way
  std::vector<LaserChange> lasers;                                              ///< of each laser
  std::optional<std::pair<std::size_t, std::size_t>> exchanged = std::nullopt;  ///< lasers, before all else
};

/// "mount: 87.1deg of laser1 (the rig has 90)".
std::string mount_in_words(const RigLaser& laser, double mount);

/// The rig as it stands.
RigChange no_change(const Rig& rig);

/// The plate counting the other way round.
RigChange other_direction(const Rig& rig);

/// Two lasers of different devices exchanged, each pair in turn.
std::vector<RigChange> exchanges(const Rig& rig);

/// A laser upside down, and its mount turned by 180, 90 and 45 degrees either way.
std::vector<RigChange> changes_of_laser(const Rig& rig, std::size_t laser);

/// The mounts of all lasers turned alike.
std::vector<RigChange> other_mounts(const Rig& rig);

/// Counts a revolution that are off by a factor of an encoder's electronics, which counts one, two or four
/// edges of each line.
std::vector<RigChange> other_counts(const Rig& rig);

/// Combinations of one change from each list: the `most` that change lasers most alike, these first.
std::vector<RigChange> combinations(const std::vector<std::vector<RigChange>>& of_lasers, std::size_t most);

/// Whether a recording may not distinguish two changes: two exchanges of lasers, or lasers upside down and
/// turned by half a turn.
bool are_alike(const RigChange& one, const RigChange& other);

/// The data as they would be with the rig changed.
class ChangedSample {
 public:
  ChangedSample(const estimate::Sample& sample, const RigChange& change);
  ChangedSample(const ChangedSample&) = delete;
  ChangedSample& operator=(const ChangedSample&) = delete;
  ~ChangedSample() = default;

  const estimate::Sample& sample() const { return sample_; }

 private:
  estimate::Sample sample_;
  PlateTrajectory plate_;
};

}  // namespace crisp::calibrate
