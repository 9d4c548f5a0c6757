// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <crisp/cloud.hpp>
#include <crisp/points.hpp>
#include <crisp/sensor_model.hpp>

#include "pipeline/estimate/sample.hpp"

namespace crisp::report {

/// The points that a report shows, as a struct of arrays: the same beams before and after a calibration.
struct ShownCloud {
  Vectors before;  ///< [m] under the rig's nominal values; empty: there is one cloud only
  Vectors after;   ///< [m] under the calibration
  std::vector<std::uint16_t> laser;
  std::vector<std::uint16_t> beam;
  std::vector<float> remission;
  std::vector<double> time;             ///< [s since the epoch]
  std::vector<double> range;            ///< [m]; empty: not known
  std::vector<double> incidence;        ///< [rad]; empty: not known; NaN: no flat surface there
  std::vector<double> distance;         ///< [m] from the surface after; NaN: no flat surface there
  std::vector<double> distance_before;  ///< [m] the same before; empty where `before` is
  std::size_t of = 0;                   ///< points that these were chosen from

  std::size_t size() const { return after.size(); }
};

/// Places beams under both models and chooses at most `count` of them evenly over the surfaces that the
/// second sees. Beams that the encoder readings do not cover under either are left out.
ShownCloud shown_cloud(const estimate::Sample& sample, const SensorModel& before, const SensorModel& after,
                       std::size_t count);

/// The same of a cloud that is placed already.
ShownCloud shown_cloud(const Cloud& cloud, std::size_t count);

}  // namespace crisp::report
