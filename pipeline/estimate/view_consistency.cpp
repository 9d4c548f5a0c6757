// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/view_consistency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "pipeline/data/recordings.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/vector_at.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::estimate {
namespace {

constexpr double kDeviationsApart = 3;  // [σ] by which views may miss one another

/// The beams by their directions, in bins of about 3°.
class Directions {
 public:
  explicit Directions(const PointsView& directions) : begins_(kBins + 1), bins_(directions.size()) {
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      bins_[i] = bin_of(directions, i);
      ++begins_[bins_[i] + 1];
    }
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    beams_.resize(bins_.size());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (std::size_t i = 0; i < bins_.size(); ++i) beams_[next[bins_[i]]++] = static_cast<std::uint32_t>(i);
  }

  std::size_t bin(std::size_t beam) const { return bins_[beam]; }
  std::span<const std::uint32_t> beams_in(std::size_t bin) const {
    return std::span(beams_).subspan(begins_[bin], begins_[bin + 1] - begins_[bin]);
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

  static constexpr std::size_t kAzimuths = 120, kHeights = 40;
  static constexpr std::size_t kBins = kAzimuths * kHeights;
  std::vector<std::size_t> begins_;   // of each bin's beams
  std::vector<std::size_t> bins_;     // of the beams
  std::vector<std::uint32_t> beams_;  // by bins
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

using Cell = std::pair<int, int>;

/// A square metre of a surfel. Over a whole wall, planes that are tilted against one another would agree on
/// average.
struct Piece {
  explicit Piece(std::size_t views) : distances(views), through(views) {}

  void add_to(PairSums& sums, const ViewErrors& errors) {
    constexpr double kFew = 5;        // beams whose median is known to half of the noise
    constexpr double kMinPart = 0.2;  // of the beams that should have met it
    const double apart = kDeviationsApart * std::hypot(errors.range, farthest * errors.angle);
    std::vector<double> middles;
    for (auto& own : distances) {
      middles.push_back(own.empty() ? 0 : statistics::median_in_place(own));
    }
    for (std::size_t view = 0; view < distances.size(); ++view) {
      const auto beams = static_cast<double>(distances[view].size());
      for (std::size_t other = 0; other < distances.size(); ++other) {
        const std::size_t pair = view * distances.size() + other;
        if (other == view || through[other] < kFew) continue;
        sums.beams[pair] += beams;
        const auto hit = static_cast<double>(distances[other].size());
        const bool meets = hit >= std::max(kFew, kMinPart * through[other]);
        if (meets && std::abs(middles[other] - middles[view]) < apart) sums.agreed[pair] += beams;
      }
    }
  }

  double farthest = 0;   ///< [m] from the spin axis
  std::set<Cell> cells;  ///< that hold a point
  /// [m] From the surface's plane, for each view, rejected beams included: a whole view may have been
  /// rejected.
  std::vector<std::vector<double>> distances;
  std::vector<double> through;  ///< for each view, beams that meet the surface or should have met it
};

/// One surfel in pieces.
class Pieces {
 public:
  Pieces(const quality::Surfel& surfel, const quality::Surfels& surfels, const quality::BeamsView& beams,
         const ViewPartition& partition)
      : surfel_(surfel), beams_(beams), partition_(partition) {
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) add(surfels.members[k]);
  }

  /// Finds the beams that go through the pieces: a beam that was measured from elsewhere may pass next to
  /// them, or end at something in front.
  void find_beams_through(std::span<const std::uint32_t> members, const Directions& directions) {
    std::set<std::size_t> bins;
    for (const std::uint32_t beam : members) bins.insert(directions.bin(beam));
    for (const std::size_t bin : bins) {
      for (const std::uint32_t beam : directions.beams_in(bin)) find_through(beam);
    }
  }

  void add_to(PairSums& sums, const ViewErrors& errors) {
    for (auto& [at, piece] : pieces_) piece.add_to(sums, errors);
  }

 private:
  static constexpr double kSide = 1;    // [m] of a piece
  static constexpr double kCell = 0.1;  // [m]

  Cell cell(const Eigen::Vector3d& from_middle, double side) const {
    return {static_cast<int>(std::floor(surfel_.u.dot(from_middle) / side)),
            static_cast<int>(std::floor(surfel_.v.dot(from_middle) / side))};
  }

  void add(std::uint32_t beam) {
    const Eigen::Vector3d point = quality::vector_at(beams_.points, beam);
    const Eigen::Vector3d from_middle = point - surfel_.middle;
    Piece& piece = pieces_.try_emplace(cell(from_middle, kSide), partition_.views.size()).first->second;
    piece.distances[partition_.of_beam[beam]].push_back(surfel_.normal.dot(from_middle));
    piece.farthest = std::max(piece.farthest, std::hypot(point.x(), point.y()));
    piece.cells.insert(cell(from_middle, kCell));
  }

  void find_through(std::uint32_t beam) {
    constexpr double kInFront = 0.3;  // [m] of a surface: what ends farther off has met something else
    constexpr double kGrazing = 0.1;  // cosine of incidence
    const Eigen::Vector3d direction = quality::vector_at(beams_.directions, beam);
    const double cosine = surfel_.normal.dot(direction);
    if (std::abs(cosine) < kGrazing) return;
    const Eigen::Vector3d from_middle = quality::vector_at(beams_.points, beam) - surfel_.middle;
    const double on = -surfel_.normal.dot(from_middle) / cosine;
    if (on > kInFront) return;
    const Eigen::Vector3d crossing = from_middle + on * direction;
    const auto piece = pieces_.find(cell(crossing, kSide));
    if (piece == pieces_.end() || !piece->second.cells.contains(cell(crossing, kCell))) return;
    piece->second.through[partition_.of_beam[beam]] += 1;
  }

  const quality::Surfel& surfel_;
  const quality::BeamsView& beams_;
  const ViewPartition& partition_;
  std::map<Cell, Piece> pieces_;
};

Orientation orientation_of(const quality::Surfel& surfel) {
  constexpr double kLevel = 0.7;  // cosine of 45° between normal and spin axis
  return std::abs(surfel.normal.z()) > kLevel ? Orientation::level : Orientation::upright;
}

/// Whether a view agrees with one besides these two, wherever they overlap.
bool agrees_with_a_third(const std::string& view, const ViewConsistency& pair,
                         const std::vector<ViewConsistency>& pairs) {
  std::map<std::string, double> least;  // share, by the other view
  for (const ViewConsistency& one : pairs) {
    if (one.view != view && one.other != view) continue;
    const std::string& other = one.view == view ? one.other : one.view;
    const auto [at, is_first] = least.try_emplace(other, one.share);
    if (!is_first) at->second = std::min(at->second, one.share);
  }
  return std::ranges::any_of(least, [&](const auto& third) {
    return third.first != pair.view && third.first != pair.other && third.second >= kConsistentShare;
  });
}

/// Which view of an inconsistent pair is wrong: the one that agrees with no third, if the other does.
std::string suspect_of(const ViewConsistency& pair, const std::vector<ViewConsistency>& pairs) {
  const bool view_agrees = agrees_with_a_third(pair.view, pair, pairs);
  const bool other_agrees = agrees_with_a_third(pair.other, pair, pairs);
  if (view_agrees == other_agrees) return "both";
  return fmt::format("{}, which agrees with no other laser", view_agrees ? pair.other : pair.view);
}

ViewPartition by_laser(const Sample& sample, const std::vector<std::string>& names) {
  return {
      .views = names,
      .of_beam = {sample.beams.laser.begin(), sample.beams.laser.end()},
      .advice =
          "the calibration is probably in a wrong local minimum. Check the rig's mount and lambda of {}, or start from calibrate.load"};
}

ViewPartition by_half(const Sample& sample) {
  ViewPartition partition{
      .views = {"the front halves of the sweeps", "the back halves"},
      .of_beam = {},
      .advice =
          "the rig's mount or counts_per_revolution is probably wrong, or the encoder is eccentric. Check both; `crisp diagnose` searches for the cause"};
  for (const float angle : sample.beams.mirror_angle) partition.of_beam.push_back(angle > 0 ? 1 : 0);
  return partition;
}

ViewPartition by_quarter(const Sample& sample) {
  ViewPartition partition{
      .views = {"the recording's first quarter", "the recording's second quarter",
                "the recording's third quarter", "the recording's last quarter"},
      .of_beam = {},
      .advice =
          "the encoder slipped or lost counts, the rig's counts_per_revolution is wrong, or the scanner was moved. Check the encoder; `crisp diagnose` searches for the cause, and corrects a slip",
      .is_by_time = true};
  const auto recordings = data::recordings_of(*sample.plate);
  const data::RecordingNumbers numbers(*sample.plate);
  for (const double time : sample.beams.time) {
    const data::Recording& own = recordings[numbers.of(time)];
    const double share = (time - own.begin) / (own.end - own.begin);
    partition.of_beam.push_back(static_cast<std::uint32_t>(std::clamp(4 * share, 0.0, 3.0)));
  }
  return partition;
}

/// Nothing where the plate's rate hardly varies.
std::optional<ViewPartition> by_rate(const Sample& sample, const std::vector<std::string>& names) {
  constexpr double kLeastVariation = 0.2;  // of the largest rate
  ViewPartition partition{
      .views = {},
      .of_beam = {},
      .advice =
          "its eta and lambda are probably in a wrong local minimum, in which errors of both cancel at one rate. Record longer and at more rates, or start from calibrate.load",
      .is_by_time = true};
  std::vector<double> rates;
  for (const double time : sample.beams.time) {
    const auto plate = sample.plate->at(time);
    rates.push_back(plate ? plate->rate : 0);
  }
  if (rates.empty()) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(rates);
  if (high - low < kLeastVariation * std::max(std::abs(low), std::abs(high))) return std::nullopt;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const std::uint32_t is_higher = rates[i] > (low + high) / 2 ? 1 : 0;
    partition.of_beam.push_back(2U * sample.beams.laser[i] + is_higher);
  }
  for (std::size_t laser = 0; laser < names.size(); ++laser) {
    partition.views.push_back(names[laser] + " at lower rates of the plate");
    partition.views.push_back(names[laser] + " at higher rates");
    partition.groups.insert(partition.groups.end(), 2, laser);
  }
  return partition;
}

}  // namespace

std::vector<ViewPartition> view_partitions(const Sample& sample, const std::vector<std::string>& names) {
  std::vector<ViewPartition> partitions;
  if (names.size() > 1) partitions.push_back(by_laser(sample, names));
  partitions.push_back(by_half(sample));
  partitions.push_back(by_quarter(sample));
  if (auto of_rates = by_rate(sample, names)) partitions.push_back(std::move(*of_rates));
  return partitions;
}

std::vector<ViewConsistency> view_consistency(const quality::Surfels& surfels,
                                              const quality::BeamsView& beams, const ViewPartition& partition,
                                              const ViewErrors& errors) {
  constexpr double kMinPart = 0.02;  // of a view's beams: fewer are no reason for a caveat
  constexpr double kMinBeams = 500;
  constexpr double kMinOfGroup = 200;  // a plate that stops shows one laser few walls meanwhile
  const std::size_t n = partition.views.size();
  const Directions directions(beams.directions);
  std::vector<PairSums> of_surfel(surfels.surfels.size(), PairSums(n));
  quality::for_each_index(of_surfel.size(), [&](std::size_t s) {
    const quality::Surfel& surfel = surfels.surfels[s];
    Pieces pieces(surfel, surfels, beams, partition);
    pieces.find_beams_through(surfels.beams_of(surfel), directions);
    pieces.add_to(of_surfel[s], errors);
  });
  const double part = kMinPart * static_cast<double>(beams.points.size()) / static_cast<double>(n);
  const double least = partition.groups.empty() ? std::max(kMinBeams, part) : kMinOfGroup;
  std::vector<ViewConsistency> pairs;
  for (const Orientation orientation : {Orientation::upright, Orientation::level}) {
    PairSums all(n);
    for (std::size_t s = 0; s < of_surfel.size(); ++s) {
      if (orientation_of(surfels.surfels[s]) == orientation) all += of_surfel[s];
    }
    for (std::size_t pair = 0; pair < n * n; ++pair) {
      if (all.beams[pair] == 0 || all.beams[pair] < least) continue;
      if (!partition.groups.empty() && partition.groups[pair / n] != partition.groups[pair % n]) continue;
      pairs.push_back({.view = partition.views[pair / n],
                       .other = partition.views[pair % n],
                       .orientation = orientation,
                       .beams = all.beams[pair],
                       .share = all.agreed[pair] / all.beams[pair],
                       .is_by_time = partition.is_by_time});
    }
  }
  return pairs;
}

const char* in_words(Orientation orientation) {
  return orientation == Orientation::upright ? "walls" : "floors and ceilings";
}

std::optional<std::string> inconsistency(const ViewPartition& partition,
                                         const std::vector<ViewConsistency>& pairs) {
  const auto least = std::ranges::min_element(pairs, {}, &ViewConsistency::share);
  if (least == pairs.end() || least->share >= kConsistentShare) return std::nullopt;
  return fmt::format(
      "{} and {} agree on {:.0f} % of the {} in common directions (expected above {:.0f} %): {}", least->view,
      least->other, 100 * least->share, in_words(least->orientation), 100 * kConsistentShare,
      fmt::format(fmt::runtime(partition.advice), suspect_of(*least, pairs)));
}

}  // namespace crisp::estimate
