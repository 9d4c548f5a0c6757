// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "pipeline/data/recordings.hpp"

namespace crisp::estimate {
namespace {

/// A number in [0, 1) that depends on nothing but the seed and the index (Steele's SplitMix64).
double uniform(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = seed * 0x9E3779B97F4A7C15U + (index + 1) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  z ^= z >> 31U;
  return static_cast<double>(z >> 11U) * 0x1.0p-53;
}

/// The factor c for which Σ min(1, c · area) is `count`, which is fewer than there are areas.
double inclusion_factor(const std::vector<double>& areas, double count) {
  double factor = 0;
  for (std::size_t certain = 0, last = areas.size(); certain != last;) {
    last = certain;
    certain = 0;
    double rest = 0;
    for (const double area : areas) {
      const bool is_certain = factor * area >= 1;
      certain += is_certain ? 1 : 0;
      rest += is_certain ? 0 : area;
    }
    // More become certain from round to round, until those that remain share what is left.
    if (rest > 0) factor = (count - static_cast<double>(certain)) / rest;
  }
  return factor;
}

/// Whether a trajectory covers times that mostly ascend.
class Coverage {
 public:
  explicit Coverage(const PlateTrajectory& plate) : plate_(plate) {}
  bool includes(double time) {
    if (arc_ && time >= arc_->begin && time <= arc_->end) return true;
    arc_ = plate_.arc(time);
    return arc_.has_value();
  }

 private:
  const PlateTrajectory& plate_;
  std::optional<PlateArc> arc_;
};

}  // namespace

Sample select(const Sample& sample, const std::function<bool(std::size_t)>& keep) {
  std::vector<std::uint32_t> which;
  for (std::uint32_t i = 0; i < sample.beams.size(); ++i) {
    if (keep(i)) which.push_back(i);
  }
  Sample kept{.plate = sample.plate};
  kept.beams.epoch_ns = sample.beams.epoch_ns;
  kept.beams.reserve(which.size());
  for (const std::uint32_t i : which) kept.beams.append(sample.beams, i);
  return kept;
}

Sample longest_recording(const Sample& sample) {
  const data::RecordingNumbers number(*sample.plate);
  if (number.count() < 2) return sample;
  std::vector<std::size_t> beams(number.count(), 0);
  for (const double time : sample.beams.time) ++beams[number.of(time)];
  const auto longest = static_cast<std::size_t>(std::ranges::max_element(beams) - beams.begin());
  return select(sample, [&](std::size_t i) { return number.of(sample.beams.time[i]) == longest; });
}

std::map<std::uint16_t, float> mirror_sweeps(const Measurements& beams) {
  std::map<std::uint16_t, std::pair<float, float>> spans;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const float angle = beams.mirror_angle[i];
    auto& [least, most] = spans.try_emplace(beams.laser[i], angle, angle).first->second;
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  std::map<std::uint16_t, float> sweeps;
  for (const auto& [laser, span] : spans) sweeps[laser] = span.second - span.first;
  return sweeps;
}

Sample of_laser(const Sample& sample, std::size_t laser) {
  return select(sample, [&](std::size_t i) { return sample.beams.laser[i] == laser; });
}

Sample covered(const Sample& sample, double earliest, double latest) {
  Coverage early(*sample.plate);
  Coverage middle(*sample.plate);
  Coverage late(*sample.plate);
  return select(sample, [&](std::size_t i) {
    const double t = sample.beams.time[i];
    return early.includes(t + earliest) && middle.includes(t) && late.includes(t + latest);
  });
}

Sample placeable(const SensorModel& model, const Sample& sample) {
  std::vector<char> is_placed(sample.beams.size(), 0);
  model.place(sample.beams, *sample.plate, [&](const PlacedRun& run) {
    std::fill_n(is_placed.begin() + static_cast<std::ptrdiff_t>(run.first), run.x.size(), 1);
  });
  return select(sample, [&](std::size_t i) { return is_placed[i] != 0; });
}

double turned(const Sample& sample) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const double time : sample.beams.time) {
    const auto state = sample.plate->at(time);
    if (!state) continue;
    least = std::min(least, state->angle);
    most = std::max(most, state->angle);
  }
  return std::max(0.0, most - least);
}

Sample in_plane(const Sample& sample, double half_width, Half half) {
  constexpr double kRight = std::numbers::pi / 2;
  return select(sample, [&](std::size_t i) {
    const double theta = sample.beams.mirror_angle[i];
    const bool front = std::abs(theta + kRight) <= half_width;
    const bool back = std::abs(theta - kRight) <= half_width;
    return (front && half != Half::kBack) || (back && half != Half::kFront);
  });
}

bool is_in_plane(const Sample& sample) {
  return std::ranges::all_of(sample.beams.mirror_angle, [](float angle) {
    return std::abs(std::abs(static_cast<double>(angle)) - std::numbers::pi / 2) < 0.5 * data::kDegree;
  });
}

Sample thin_by_area(const Sample& sample, const SensorModel& model, std::size_t count, std::uint64_t seed) {
  const std::size_t n = sample.beams.size();
  if (n <= count) return sample;
  const Placed placed = model.place(sample.beams, *sample.plate);
  std::vector<double> areas(n, 0.0);
  for (std::size_t k = 0; k < placed.index.size(); ++k) {
    const auto point = placed.points.col(static_cast<Eigen::Index>(k));
    areas[placed.index[k]] =
        sample.beams.range[placed.index[k]] * std::sqrt(point.x() * point.x() + point.y() * point.y());
  }
  const double factor = inclusion_factor(areas, static_cast<double>(count));
  return select(sample, [&](std::size_t i) { return uniform(seed, i) < factor * areas[i]; });
}

Sample thin_evenly(const Sample& sample, std::size_t count, std::uint64_t seed) {
  const double share =
      static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, sample.beams.size()));
  return select(sample, [&](std::size_t i) { return uniform(seed, i) < share; });
}

std::size_t beams_for(double sigma, std::size_t most) {
  constexpr double kWide = 0.1;      // [m]
  constexpr std::size_t kMin = 400;  // a few turns of a beam in the plate's plane
  const auto some = static_cast<std::size_t>(static_cast<double>(most) * std::min(1.0, kWide / sigma));
  return std::min(most, std::max(some, kMin));
}

Sample thin_for(double sigma, const Sample& sample) {
  const std::size_t n = sample.beams.size();
  const double share =
      static_cast<double>(beams_for(sigma, n)) / static_cast<double>(std::max<std::size_t>(1, n));
  std::vector<double> due;  // of the back and the front beams of each laser
  return select(sample, [&](std::size_t i) {
    const std::size_t whose =
        2 * std::size_t{sample.beams.laser[i]} + (sample.beams.mirror_angle[i] < 0 ? 1 : 0);
    if (due.size() <= whose) due.resize(whose + 1);
    double& own = due[whose];
    own += share;
    if (own < 1) return false;
    own -= 1;
    return true;
  });
}

namespace {

double usual_interval(const PlateTrajectory& piece) {
  if (piece.size() < 2) return 0;
  return (piece.end() - piece.begin()) / static_cast<double>(piece.size() - 1);
}

}  // namespace

PlateTrajectory joined(const std::vector<std::shared_ptr<const PlateTrajectory>>& pieces) {
  constexpr double kSame =
      0.5;  // of the usual interval: what is nearer is the same reading, or as good as it
  if (pieces.empty()) return {};
  std::vector<double> times;
  std::vector<double> angles;
  std::vector<double> new_zeros;
  for (const auto& piece : pieces) {
    const double same = kSame * usual_interval(*piece);
    new_zeros.insert(new_zeros.end(), piece->new_zeros().begin(), piece->new_zeros().end());
    bool goes_on = times.empty();
    for (std::size_t i = 0; i < piece->size(); ++i) {
      if (!goes_on && piece->times()[i] <= times.back() + same) continue;
      goes_on = true;
      times.push_back(piece->times()[i]);
      angles.push_back(piece->angles()[i]);
    }
  }
  return {pieces.front()->epoch_ns(), std::move(times), std::move(angles), pieces.front()->max_gap(),
          std::move(new_zeros)};
}

}  // namespace crisp::estimate
