// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {

/// Motion of a laser's mirror: real units are up to 0.6 % slow and wander by 0.2 % within seconds.
struct MirrorSettings {
  double frequency = 50;  ///< [Hz] nominal
  double slowest = 6e-3;  ///< each unit's mean period is drawn: longer than nominal by up to this share
  double wander = 2e-3;   ///< largest slow departure from the mean, as a share of the period
  double jitter = 0;      ///< standard deviation of each single period, as a share of it
};

/// One turn of the mirror.
struct Revolution {
  std::uint64_t number = 0;  ///< counts from 0
  double begin = 0;          ///< [s] true time of its index: the laser's first possible beam is fired
  double period = 0;         ///< [s] until the next one's index
};

/// The turns of one laser's mirror, one after the other. The first begins within a period after time 0.
class Mirror {
 public:
  /// @param excess  [s] of the mean period over the nominal one; 0: as drawn
  Mirror(const MirrorSettings& settings, std::uint64_t seed, const std::string& laser, double excess = 0);

  Revolution next();

  /// The largest departure of a mirror whose period wanders by `rms`, both as a share of it.
  static double wander_of_rms(double rms);

 private:
  static constexpr std::size_t kWaves = 3;
  struct Wave {
    double amplitude;
    double angular_frequency;
    double phase;
  };

  MirrorSettings settings_;
  double slowness_ = 0;
  statistics::RandomStream jitter_;
  std::array<Wave, kWaves> waves_{};
  double time_ = 0;
  std::uint64_t number_ = 0;
};

}  // namespace crisp::simulate
