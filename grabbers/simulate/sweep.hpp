// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "grabbers/simulate/mirror_rotation.hpp"
#include "grabbers/simulate/motion.hpp"
#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scene.hpp"
#include "grabbers/simulate/settings.hpp"
#include "grabbers/simulate/spot.hpp"
#include "pipeline/model/chain.hpp"

namespace crisp::simulate {

/// Measurements of one laser in one turn of its mirror.
struct Sweep {
  std::uint16_t laser = 0;  ///< index in the rig
  Revolution revolution;
  std::vector<std::uint16_t> beams;     ///< index of each beam in its scan
  std::vector<double> times;            ///< [s] true time at which each was fired
  std::vector<float> ranges;            ///< [m] as the device measures them; 0 where nothing came back
  std::vector<float> remissions;        ///< 0 to 254
  std::vector<float> cos_incidences;    ///< |cos β| on what was met; of no use at range 0
  std::vector<std::uint32_t> surfaces;  ///< index of the scene's thing that was met; of no use at range 0
};

/// Fires the beams of a scanner's lasers at a scene, sweep by sweep, through the sensor model: what is hidden
/// in the true calibration is what calibration and assembly undo with the same code.
class SweepSimulator {
 public:
  /// @param settings  checked here
  /// @param scene     in the base's frame
  /// @param motion    the plate's true motion, by true time [s]; kept by reference
  /// @param terms     that the true calibration names
  /// @throws Error    if the settings make no sense, or the truth does not have one laser for each of the rig
  SweepSimulator(const ScannerSettings& settings, const Scene& scene, const Motion& motion,
                 const TermRegistry& terms);

  /// The next sweep of any laser, in the order in which they begin. Endless.
  Sweep next();

 private:
  struct Laser {
    Mirror mirror;
    RangeNoise noise;
    statistics::RandomStream foliage;
    Spot spot;
    Revolution upcoming;
    FieldOfView field;
    std::vector<std::uint16_t> beams;  ///< that it fires
    Interleave interleave;
    std::vector<double> parameters;  ///< of its chain: λ, τ, α, η and those of its terms
  };

  void aim(Laser& laser, Sweep& sweep);
  void measure(Laser& laser, Sweep& sweep);

  ScannerSettings settings_;
  const Motion* motion_;
  RayCaster caster_;
  SensorModel model_;
  std::vector<Laser> lasers_;
  std::vector<Beam<double>> traced_;
};

}  // namespace crisp::simulate
