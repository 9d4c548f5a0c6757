// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/predicted_recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/quality/vector_at.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Which surfel is seen from the plate's centre, by direction.
class DirectionMap {
 public:
  void add(const Eigen::Vector3d& point, std::uint32_t surfel) { cells_[cell_of(point)] = surfel; }
  std::uint32_t at(const Eigen::Vector3d& point) const { return cells_[cell_of(point)]; }

 private:
  static constexpr double kCell = 2 * data::kDegree;
  static constexpr std::size_t kColumns = 180;
  static constexpr std::size_t kRows = 90;

  static std::size_t cell_of(const Eigen::Vector3d& point) {
    const double azimuth = std::atan2(point.y(), point.x()) + std::numbers::pi;
    const double inclination = std::atan2(point.head<2>().norm(), point.z());
    const auto column = std::min(kColumns - 1, static_cast<std::size_t>(azimuth / kCell));
    return std::min(kRows - 1, static_cast<std::size_t>(inclination / kCell)) * kColumns + column;
  }

  std::vector<std::uint32_t> cells_ = std::vector<std::uint32_t>(kColumns * kRows, kNone);
};

quality::Surfel seen_from(const Standpoint& standpoint, quality::Surfel surfel) {
  for (Eigen::Vector3d* vector : {&surfel.middle, &surfel.normal, &surfel.u, &surfel.v})
    *vector = standpoint.attitude.transpose() * *vector;
  surfel.middle *= standpoint.distance;
  surfel.radius *= standpoint.distance;
  return surfel;
}

/// [m] The longest range that is measured there.
float longest_from(const Standpoint& standpoint, const Measurements& beams) {
  constexpr float kUsual = 20;  // of a laser's reach
  float longest = standpoint.distance > 1 ? kUsual : 0;
  for (const float range : beams.range) longest = std::max(longest, range);
  return longest;
}

/// [m] By how much a beam must be longer to end on the surfel's plane; nothing where it grazes it.
double to_plane(const quality::Surfel& surfel, const Eigen::Vector3d& end, const Eigen::Vector3d& direction) {
  constexpr double kGrazing = 0.1;
  const double across = surfel.normal.dot(direction);
  return std::abs(across) < kGrazing ? std::numeric_limits<double>::quiet_NaN()
                                     : surfel.normal.dot(surfel.middle - end) / across;
}

/// Lets each beam end on the surfel in its direction, seen from the lasers' places: those lie off the centre,
/// so that the direction depends on the range.
///
/// @return the surfel of each beam; kNone for those without
std::vector<std::uint32_t> cast(const SensorModel& model, PredictedRecording& recording,
                                const DirectionMap& map, float longest) {
  constexpr int kIterations = 4;
  constexpr float kShortest = 0.1F;  // [m]
  std::vector<std::uint32_t> met(recording.beams.size(), kNone);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const estimate::PlacedBeams placed(model, recording.sample());
    const quality::BeamsView view = placed.view();
    for (std::size_t i = 0; i < met.size(); ++i) {
      const Eigen::Vector3d end = quality::vector_at(view.points, i);
      const std::uint32_t before = std::exchange(met[i], map.at(end));
      if (met[i] == kNone) continue;
      const double longer =
          to_plane(recording.surfels.surfels[met[i]], end, quality::vector_at(view.directions, i));
      const float range = recording.beams.range[i] + static_cast<float>(longer);
      const bool has_moved = iteration + 1 == kIterations && met[i] != before;
      if (range > kShortest && range <= longest && !has_moved)
        recording.beams.range[i] = range;
      else
        met[i] = kNone;
    }
  }
  return met;
}

/// Leaves the beams that meet a surfel, and makes them its members.
void keep(PredictedRecording& recording, const std::vector<std::uint32_t>& met) {
  std::vector<std::vector<std::uint32_t>> members(recording.surfels.surfels.size());
  std::uint32_t kept = 0;
  for (const std::uint32_t surfel : met) {
    if (surfel != kNone) members[surfel].push_back(kept++);
  }
  recording.beams =
      estimate::select(recording.sample(), [&](std::size_t i) { return met[i] != kNone; }).beams;
  quality::Surfels surfels;
  for (std::size_t s = 0; s < members.size(); ++s) {
    if (members[s].size() > 3) surfels.add(recording.surfels.surfels[s], members[s]);
  }
  recording.surfels = std::move(surfels);
}

}  // namespace

PredictedRecording predicted_recording(const SensorModel& model, const estimate::Sample& pattern,
                                       const quality::BeamsView& placed, const quality::Surfels& surfels,
                                       std::vector<double> angles, const Standpoint& standpoint) {
  PredictedRecording recording{
      .plate = pattern.plate->with_angles(std::move(angles)), .beams = pattern.beams, .surfels = {}};
  recording.beams.cos_incidence.clear();
  DirectionMap map;
  for (const quality::Surfel& surfel : surfels.surfels) {
    const auto number = static_cast<std::uint32_t>(recording.surfels.surfels.size());
    recording.surfels.surfels.push_back(seen_from(standpoint, surfel));
    for (const std::uint32_t beam : surfels.beams_of(surfel))
      map.add(standpoint.attitude.transpose() * quality::vector_at(placed.points, beam), number);
  }
  keep(recording, cast(model, recording, map, longest_from(standpoint, pattern.beams)));
  return recording;
}

}  // namespace crisp::diagnose
