// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crisp {

/// n measurements in the order of firing, as a struct of arrays of equal length (cos_incidence may be empty).
/// No calibration is applied, so that they can be replayed under any. Usually one scan, but any number of
/// beams of any lasers will do.
struct Measurements {
  std::int64_t epoch_ns = 0;        ///< [ns since the Unix epoch] zero of `time`; the same for a whole run
  std::vector<float> range;         ///< [m], > 0: beams without an echo are not here
  std::vector<float> mirror_angle;  ///< [rad] θ of equation (2): reported angle − mount
  std::vector<double> time;         ///< [s since epoch] hub time at which the beam was fired (η not applied)
  std::vector<std::uint16_t> laser;  ///< index of the laser in the rig
  std::vector<float> remission;      ///< device's units, 0 where unknown
  std::vector<std::uint16_t> beam;   ///< index of the beam in its scan
  std::vector<float> cos_incidence;  ///< |cos β| on the surface that was met; empty where nobody has found it

  std::size_t size() const { return range.size(); }  ///< number of measurements
  /// Makes room for n measurements in all.
  void reserve(std::size_t n);
  /// Appends; incidences are dropped if only one of the two has them. @throws Error if the epochs differ
  void append(const Measurements& other);

  /// One beam of another set, which must have the same epoch, and know the incidences if this one does.
  void append(const Measurements& other, std::size_t i) {
    range.push_back(other.range[i]);
    mirror_angle.push_back(other.mirror_angle[i]);
    time.push_back(other.time[i]);
    laser.push_back(other.laser[i]);
    remission.push_back(other.remission[i]);
    beam.push_back(other.beam[i]);
    if (!other.cos_incidence.empty()) cos_incidence.push_back(other.cos_incidence[i]);
  }
};

}  // namespace crisp
