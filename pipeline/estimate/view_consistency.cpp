// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/view_consistency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "pipeline/data/recordings.hpp"
#include "pipeline/data/robust.hpp"
#include "pipeline/quality/blocks.hpp"

namespace crisp {
namespace {

constexpr double kExpectedShare = 0.7;  // in halls and streets, with the true calibration; in rooms 0.9

/// Directions from the scanner in bins of about 6°, and which views measure in them.
class Directions {
 public:
  Directions(const BeamsView& beams, const ViewPartition& partition)
      : views_(partition.views.size()), counts_(kBins * views_), bins_(partition.of_beam.size()) {
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      bins_[i] = bin_of(beams.directions, i);
      ++counts_[bins_[i] * views_ + partition.of_beam[i]];
    }
  }

  /// Whether a view measures where a beam went.
  bool has(std::size_t beam, std::size_t view) const {
    constexpr std::uint32_t kFew = 5;
    return counts_[bins_[beam] * views_ + view] >= kFew;
  }

 private:
  static std::size_t bin_of(const PointsView& directions, std::size_t i) {
    const double azimuth = std::atan2(directions.y[i], directions.x[i]) / (2 * std::numbers::pi) + 0.5;
    const double height = (directions.z[i] + 1) / 2;
    const auto within = [](double share, std::size_t bins) {
      return std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)));
    };
    return within(azimuth, kAzimuths) * kHeights + within(height, kHeights);
  }

  static constexpr std::size_t kAzimuths = 60, kHeights = 20;
  static constexpr std::size_t kBins = kAzimuths * kHeights;
  std::size_t views_;
  std::vector<std::uint32_t> counts_;  // bins × views
  std::vector<std::size_t> bins_;      // of the beams
};

/// Sums over surfels for each ordered pair of views.
struct PairSums {
  explicit PairSums(std::size_t views) : beams(views * views), agreed(views * views) {}
  void operator+=(const PairSums& other) {
    for (std::size_t k = 0; k < beams.size(); ++k) {
      beams[k] += other.beams[k];
      agreed[k] += other.agreed[k];
    }
  }
  std::vector<double> beams;
  std::vector<double> agreed;
};

/// A square metre of a surfel. Over a whole wall, planes that are tilted against one another would agree on
/// average.
struct Piece {
  explicit Piece(std::size_t views) : distances(views), within(views * views) {}

  void add(std::size_t view, double distance, const std::vector<bool>& has_others) {
    distances[view].push_back(distance);
    for (std::size_t other = 0; other < distances.size(); ++other) {
      within[view * distances.size() + other] += has_others[other] ? 1 : 0;
    }
  }

  void add_to(PairSums& sums, double apart) {
    constexpr double kFew = 5;           // beams whose median is known to half of the noise
    constexpr double kLeastPart = 0.01;  // of the piece's beams
    double all = 0;
    std::vector<double> middles;
    for (auto& own : distances) {
      all += static_cast<double>(own.size());
      middles.push_back(own.empty() ? 0 : middle_of(own));
    }
    for (std::size_t view = 0; view < distances.size(); ++view) {
      for (std::size_t other = 0; other < distances.size(); ++other) {
        const std::size_t pair = view * distances.size() + other;
        if (other == view || within[pair] == 0) continue;
        sums.beams[pair] += within[pair];
        const bool meets = static_cast<double>(distances[other].size()) >= std::max(kFew, kLeastPart * all);
        if (meets && std::abs(middles[other] - middles[view]) < apart) sums.agreed[pair] += within[pair];
      }
    }
  }

  /// [m] From the surface's plane, for each view. Of beams that were rejected as well: a whole view may have
  /// been.
  std::vector<std::vector<double>> distances;
  std::vector<double>
      within;  // of a view's beams those in directions in which another one measures, by pairs
};

void add(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams, const ViewPartition& partition,
         const Directions& directions, double apart, PairSums& sums) {
  constexpr double kSide = 1;  // [m]
  const std::size_t n = partition.views.size();
  std::map<std::pair<int, int>, Piece> pieces;
  std::vector<bool> has_others(n);
  for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
    const std::uint32_t beam = surfels.members[k];
    const Eigen::Vector3d point(beams.points.x[beam], beams.points.y[beam], beams.points.z[beam]);
    const Eigen::Vector3d from_middle = point - surfel.middle;
    const std::pair at(static_cast<int>(std::floor(surfel.u.dot(from_middle) / kSide)),
                       static_cast<int>(std::floor(surfel.v.dot(from_middle) / kSide)));
    for (std::size_t other = 0; other < n; ++other) has_others[other] = directions.has(beam, other);
    pieces.try_emplace(at, n).first->second.add(partition.of_beam[beam], surfel.normal.dot(from_middle),
                                                has_others);
  }
  for (auto& [at, piece] : pieces) piece.add_to(sums, apart);
}

Orientation orientation_of(const Surfel& surfel) {
  constexpr double kLevel = 0.7;  // cosine of 45° between normal and spin axis
  return std::abs(surfel.normal.z()) > kLevel ? Orientation::level : Orientation::upright;
}

ViewPartition by_laser(const Sample& sample, const std::vector<std::string>& names) {
  return {.views = names,
          .of_beam = {sample.beams.laser.begin(), sample.beams.laser.end()},
          .advice =
              "the calibration is probably in a wrong local minimum. Check the rig's mount and lambda of "
              "both, or "
              "start from calibrate.load"};
}

ViewPartition by_half(const Sample& sample) {
  ViewPartition partition{.views = {"the front halves of the sweeps", "the back halves"},
                          .of_beam = {},
                          .advice =
                              "the rig's mount or counts_per_revolution is probably wrong, or the encoder is "
                              "eccentric. Check both; configs/diagnose.yaml looks for the cause"};
  for (const float angle : sample.beams.mirror_angle) partition.of_beam.push_back(angle > 0 ? 1 : 0);
  return partition;
}

ViewPartition by_quarter(const Sample& sample) {
  ViewPartition partition{.views = {"the recording's first quarter", "its second quarter",
                                    "its third quarter", "its last quarter"},
                          .of_beam = {},
                          .advice =
                              "the encoder slipped or lost counts, the rig's counts_per_revolution is wrong, "
                              "or the scanner was moved. "
                              "Check the encoder; configs/diagnose.yaml looks for the cause"};
  const auto recordings = recordings_of(*sample.plate);
  const RecordingNumbers numbers(*sample.plate);
  for (const double time : sample.beams.time) {
    const Recording& own = recordings[numbers.of(time)];
    const double share = (time - own.begin) / (own.end - own.begin);
    partition.of_beam.push_back(static_cast<std::uint32_t>(std::clamp(4 * share, 0.0, 3.0)));
  }
  return partition;
}

}  // namespace

std::vector<ViewPartition> view_partitions(const Sample& sample, const std::vector<std::string>& names) {
  std::vector<ViewPartition> partitions;
  if (names.size() > 1) partitions.push_back(by_laser(sample, names));
  partitions.push_back(by_half(sample));
  partitions.push_back(by_quarter(sample));
  return partitions;
}

std::vector<ViewConsistency> view_consistency(const Surfels& surfels, const BeamsView& beams,
                                              const ViewPartition& partition, double noise) {
  constexpr double kApart = 3;          // [σ]
  constexpr double kLeastShare = 0.02;  // of all beams: fewer are no reason to doubt
  constexpr std::size_t kLeastBlock = 64, kMostBlocks = 8;
  const std::size_t n = partition.views.size();
  const Directions directions(beams, partition);
  const std::size_t block = std::max(kLeastBlock, surfels.surfels.size() / kMostBlocks);
  std::vector<ViewConsistency> pairs;
  for (const Orientation orientation : {Orientation::upright, Orientation::level}) {
    const auto add_block = [&](PairSums& sums, std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        if (orientation_of(surfels.surfels[s]) != orientation) continue;
        add(surfels.surfels[s], surfels, beams, partition, directions, kApart * noise, sums);
      }
    };
    const auto all = sum_over_blocks(surfels.surfels.size(), block, PairSums(n), add_block);
    const double least = kLeastShare * static_cast<double>(beams.points.size()) / static_cast<double>(n);
    for (std::size_t pair = 0; pair < n * n; ++pair) {
      if (all.beams[pair] == 0 || all.beams[pair] < least) continue;
      pairs.push_back({.view = partition.views[pair / n],
                       .other = partition.views[pair % n],
                       .orientation = orientation,
                       .beams = all.beams[pair],
                       .share = all.agreed[pair] / all.beams[pair]});
    }
  }
  return pairs;
}

const char* in_words(Orientation orientation) {
  return orientation == Orientation::upright ? "walls" : "floors and ceilings";
}

std::optional<std::string> inconsistency(const ViewPartition& partition,
                                         const std::vector<ViewConsistency>& pairs) {
  constexpr double kLeastShare = 0.5;
  const auto least = std::ranges::min_element(pairs, {}, &ViewConsistency::share);
  if (least == pairs.end() || least->share >= kLeastShare) return std::nullopt;
  return fmt::format(
      "{} and {} agree on {:.0f} % of the {} in common directions (expected above {:.0f} %): {}", least->view,
      least->other, 100 * least->share, in_words(least->orientation), 100 * kExpectedShare, partition.advice);
}

}  // namespace crisp
