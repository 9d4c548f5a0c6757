// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scene/moving_objects.hpp"

#include <algorithm>

#include "pipeline/statistics/multiple_testing.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::diagnose {
namespace {

struct Shot {
  std::uint32_t beam = 0, scan = 0;
};

/// Outlying shots on a grid of beams and scans.
class Grid {
 public:
  explicit Grid(const FarShots& far)
      : beams_(far.of_beam.size()), scans_(far.scans), is_far_(beams_ * scans_) {
    for (std::size_t beam = 0; beam < beams_; ++beam) {
      for (const std::uint32_t scan : far.of_beam[beam]) add(static_cast<std::uint32_t>(beam), scan);
    }
  }

  /// Permutes the scans within each beam.
  void scatter_randomly(statistics::RandomStream& random) {
    const std::vector<Shot> before = std::move(shots_);
    shots_.clear();
    for (const Shot& shot : before) is_far_[index(shot)] = false;
    const auto any = [&] { return static_cast<std::uint32_t>(random.below(scans_)); };
    for (const Shot& shot : before) {
      std::uint32_t scan = any();
      while (is_far_[index({shot.beam, scan})]) scan = any();
      add(shot.beam, scan);
    }
  }

  /// Shots in clusters.
  std::vector<Shot> together() const {
    std::vector<bool> is_left = is_far_;
    std::vector<Shot> all;
    for (const Shot& shot : shots_) {
      const std::vector<Shot> group = group_of(shot, is_left);
      if (is_a_thing(group)) all.insert(all.end(), group.begin(), group.end());
    }
    return all;
  }

 private:
  std::size_t index(const Shot& shot) const { return shot.beam * scans_ + shot.scan; }

  void add(std::uint32_t beam, std::uint32_t scan) {
    shots_.push_back({beam, scan});
    is_far_[index(shots_.back())] = true;
  }

  /// Connected component of one shot (flood fill); its shots are removed from `is_left`.
  std::vector<Shot> group_of(const Shot& first, std::vector<bool>& is_left) const {
    std::vector<Shot> group;
    const auto take = [&](const Shot& shot) {
      if (!is_left[index(shot)]) return;
      is_left[index(shot)] = false;
      group.push_back(shot);
    };
    const auto from = [](std::uint32_t middle) { return middle - std::min(middle, kReach); };
    const auto to = [](std::uint32_t middle, std::size_t end) {
      return std::min(middle + kReach + 1, static_cast<std::uint32_t>(end));
    };
    take(first);
    std::size_t done = 0;  // visited part of the growing cluster
    while (done < group.size()) {
      const Shot middle = group[done++];
      for (std::uint32_t beam = from(middle.beam); beam < to(middle.beam, beams_); ++beam) {
        for (std::uint32_t scan = from(middle.scan); scan < to(middle.scan, scans_); ++scan)
          take({beam, scan});
      }
    }
    return group;
  }

  static bool is_a_thing(const std::vector<Shot>& group) {
    constexpr std::size_t kMin = 20;
    constexpr std::uint32_t kNarrowest = 3;  // beams and scans
    if (group.size() < kMin) return false;
    const auto wide = [&](std::uint32_t Shot::*along) {
      const auto [least, most] = std::ranges::minmax(group, {}, along);
      return most.*along - least.*along + 1 >= kNarrowest;
    };
    return wide(&Shot::beam) && wide(&Shot::scan);
  }

  static constexpr std::uint32_t kReach = 2;  // beams and scans

  std::size_t beams_, scans_;
  std::vector<bool> is_far_;
  std::vector<Shot> shots_;
};

/// Permutation test: p-value of the number of clustered shots.
double p_value_of(std::size_t together, Grid grid, std::size_t shuffles, std::uint64_t seed) {
  statistics::RandomStream random(seed, "moving objects");
  for (std::size_t shuffle = 0; shuffle < shuffles; ++shuffle) {
    grid.scatter_randomly(random);
    if (grid.together().size() >= together)
      return 2.0 / (2.0 + static_cast<double>(shuffle));  // early stop (sequential Monte Carlo test)
  }
  return 1.0 / (1.0 + static_cast<double>(shuffles));
}

}  // namespace

std::optional<MovingObjects> find_moving_objects(const FarShots& far, std::size_t views, std::uint64_t seed) {
  constexpr double kByChance = 0.002;
  constexpr std::size_t kNextTo = 5;  // beams on either side: approach of the object, and its soft outline
  const Grid grid(far);
  const std::vector<Shot> shots = grid.together();
  if (shots.empty()) return std::nullopt;
  MovingObjects result{
      .beams = std::vector<bool>(far.of_beam.size()),
      .share = static_cast<double>(shots.size()) / static_cast<double>(far.shots),
      .p_value = statistics::sidak_p_value(static_cast<double>(views),
                                           p_value_of(shots.size(), grid, 1000 * views - 1, seed))};
  if (!(result.p_value < kByChance)) return std::nullopt;
  std::vector<bool> covered(far.of_beam.size());
  for (const Shot& shot : shots) {
    covered[shot.beam] = true;
    const std::size_t end = std::min(shot.beam + kNextTo + 1, covered.size());
    for (std::size_t b = shot.beam - std::min<std::size_t>(shot.beam, kNextTo); b < end; ++b)
      result.beams[b] = true;
  }
  result.directions = static_cast<std::size_t>(std::ranges::count(covered, true));
  return result;
}

Finding finding_of(const MovingObjects& moved) {
  const auto parameter = [](const char* name, double value) {
    return Parameter{.name = name, .unit = "1", .value = value, .std_error = kNotTested};
  };
  return {.cause = "scene.moving",
          .scope = "scene",
          .parameters = {parameter("hidden_share", moved.share),
                         parameter("directions", static_cast<double>(moved.directions))},
          .explained_fraction = kNotTested,
          .p_value = moved.p_value,
          .confounded_with = {},
          .gain = {},
          .accepted = true};
}

}  // namespace crisp::diagnose
