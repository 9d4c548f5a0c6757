// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include <crisp/sensor_model.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp::estimate {

/// The measurements that a calibration uses, with the plate's motion during them.
struct Sample {
  Measurements beams;
  const PlateTrajectory* plate = nullptr;
};

/// The beams for which `keep(index)` holds, in their order.
Sample select(const Sample& sample, const std::function<bool(std::size_t)>& keep);

/// The beams of the recording that has the most of them: see recordings_of().
Sample longest_recording(const Sample& sample);

/// [rad] Over which each laser's beams spread, by its number.
std::map<std::uint16_t, float> mirror_sweeps(const Measurements& beams);

/// [rad] A mirror sweeps over more than this; the beams of a single-beam device have all but one angle.
inline constexpr float kLeastSweep = 30 * data::kDegree;

/// The beams of one laser.
Sample of_laser(const Sample& sample, std::size_t laser);

/// The beams whose plate angle is known for every η between `earliest` and `latest` [s]: calibration may then
/// vary η while the set of points stays the same.
Sample covered(const Sample& sample, double earliest, double latest);

/// The beams whose plate angle is known at the times that a model gives them: terms of time move them beyond
/// η.
Sample placeable(const SensorModel& model, const Sample& sample);

/// [rad] Between the least and the greatest angle that the plate had while beams were fired.
double turned(const Sample& sample);

/// The two beams of each scan that lie in the plate's plane (θ = ±90°), or as near to it as the angular step
/// allows. `half` selects.
enum class Half { kFront, kBack, kBoth };  ///< θ < 0 (reported −45° with the usual mount), θ > 0 (135°), both
Sample in_plane(const Sample& sample, double half_width, Half half);

/// Whether all beams lie in the plate's plane (θ = ±90°) to within half a degree, a mirror's coarsest step.
bool is_in_plane(const Sample& sample);

/// Thins a sample to about `count` beams, evenly over the surfaces that they hit: a beam is kept with a
/// probability in proportion to the area it stands for, range × distance from the spin axis, up to certainty.
/// Beams crowd at the spin axis, where an entropy over all of them would draw the whole cloud onto it.
///
/// @param model  places the beams; a rough calibration will do
Sample thin_by_area(const Sample& sample, const SensorModel& model, std::size_t count, std::uint64_t seed);

/// Thins to about `count` beams, each as likely to be kept as any other.
Sample thin_evenly(const Sample& sample, std::size_t count, std::uint64_t seed);

/// The number of beams, up to `most`, that a kernel of width σ [m] needs: wide kernels are smooth.
std::size_t beams_for(double sigma, std::size_t most);

/// Thins an in-plane sample to as many beams, evenly along the time of each laser's front and back beams:
/// random thinning would give a wide kernel spurious local minima.
Sample thin_for(double sigma, const Sample& sample);

/// Joins pieces of a trajectory that overlap or follow one another. A reading's times in two pieces differ by
/// microseconds, since each piece has its own clock line: the earlier piece's reading is kept, and the later
/// piece continues at the first reading behind it. (Both, a nanosecond apart, would be a plate of 10⁷ rad/s.)
PlateTrajectory joined(const std::vector<std::shared_ptr<const PlateTrajectory>>& pieces);

}  // namespace crisp::estimate
