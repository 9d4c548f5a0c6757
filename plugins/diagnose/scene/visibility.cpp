// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scene/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "pipeline/statistics/monte_carlo_test.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Cell and time of one observation of a direction.
struct Observation {
  std::size_t laser = 0;
  std::size_t column = 0;  // of plate angle
  double place = 0;        // of the plate angle within the column, 0 to 1
  std::size_t row = 0;     // of mirror angle
  std::size_t when = 0;    // half turns of the plate since the first beam, at the median rate
};

/// Grid of directions; its columns are as wide as the plate turns between two scans.
class RepeatGrid {
 public:
  RepeatGrid(const Measurements& beams, const PlateTrajectory& plate) : plate_(plate) {
    constexpr double kNarrowest = std::numbers::pi / 90;
    std::vector<double> turned;
    std::vector<double> rates;
    std::map<std::uint16_t, double> last;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (i > 0 && beams.laser[i] == beams.laser[i - 1] && beams.beam[i] > beams.beam[i - 1]) continue;
      const auto state = plate.at(beams.time[i]);
      if (!state) continue;
      rates.push_back(std::abs(state->rate));
      const auto [before, is_first] = last.try_emplace(beams.laser[i], state->angle);
      if (!is_first) turned.push_back(std::abs(state->angle - before->second));
      before->second = state->angle;
    }
    if (turned.empty()) return;
    const double side = std::max(kNarrowest, statistics::median_in_place(turned));
    columns_ = std::max<std::size_t>(1, static_cast<std::size_t>(kTurn / side));
    half_turn_ = std::numbers::pi / std::max(1e-3, statistics::median_in_place(rates));
    start_ = std::ranges::min(beams.time);
    whens_ = 1 + static_cast<std::size_t>((std::ranges::max(beams.time) - start_) / half_turn_);
    lasers_ = std::size_t{std::ranges::max(beams.laser)} + 1;
  }

  std::size_t cells() const { return lasers_ * columns_ * kRows; }
  std::size_t whens() const { return whens_; }
  std::size_t cell(const Observation& observation) const {
    return (observation.laser * columns_ + observation.column) * kRows + observation.row;
  }
  std::optional<Observation> observation(const Measurements& beams, std::size_t i) const {
    const auto state = plate_.at(beams.time[i]);
    if (!state) return std::nullopt;
    const double phase = state->angle / kTurn - std::floor(state->angle / kTurn);
    const double columns = phase * static_cast<double>(columns_);
    const std::size_t column = std::min(columns_ - 1, static_cast<std::size_t>(columns));
    const double mirror = double{beams.mirror_angle[i]} / kTurn + 0.5;
    return Observation{.laser = beams.laser[i],
                       .column = column,
                       .place = columns - static_cast<double>(column),
                       .row = static_cast<std::size_t>((mirror - std::floor(mirror)) * double{kRows}) % kRows,
                       .when = static_cast<std::size_t>((beams.time[i] - start_) / half_turn_)};
  }
  /// Cells of the same row in the column before, the same and the next one.
  std::array<std::size_t, 3> along_row(std::size_t cell) const {
    const std::size_t row = cell % kRows;
    const std::size_t column = cell / kRows % columns_;
    const std::size_t laser = cell / kRows / columns_;
    const auto at = [&](std::size_t c) { return (laser * columns_ + c % columns_) * kRows + row; };
    return {at(column + columns_ - 1), cell, at(column + 1)};
  }
  /// Cells around a cell and the cell itself; fewer at the ends of the mirror's sweep.
  std::vector<std::size_t> around(std::size_t cell) const {
    std::vector<std::size_t> cells;
    for (const std::size_t c : along_row(cell)) {
      const std::size_t row = c % kRows;
      for (const std::size_t r : {row + kRows - 1, row, row + 1}) cells.push_back(c - row + r % kRows);
    }
    return cells;
  }

 private:
  static constexpr std::size_t kRows = 180;

  const PlateTrajectory& plate_;
  std::size_t lasers_ = 0;
  std::size_t columns_ = 1;
  std::size_t whens_ = 0;
  double half_turn_ = 1;  // [s]
  double start_ = 0;      // [s]
};

/// Visibility by cell and time: the majority of the beams, if they agree. Only times with beams are stored,
/// since on a fast head most cells are empty at most times.
class VisibilityGrid {
 public:
  explicit VisibilityGrid(const RepeatGrid& grid) : whens_(grid.whens()), cells_(grid.cells()) {}

  /// Adds an observation; those of a cell must be in order of time.
  void add(std::size_t cell, const Observation& observation, Visibility visibility) {
    auto& counts = cells_[cell];
    const auto when = static_cast<std::uint32_t>(observation.when);
    if (counts.empty() || counts.back().when != when) counts.push_back({when});
    counts.back().places += observation.place;
    if (visibility == Visibility::kSurface) ++counts.back().surface;
    if (visibility == Visibility::kHidden) ++counts.back().hidden;
  }

  std::vector<Visibility> views(std::size_t cell) const {
    std::vector<Visibility> views(whens_, Visibility::kNone);
    for (const Count& count : cells_[cell]) views[count.when] = count.visibility();
    return views;
  }
  bool changes(std::size_t cell) const {
    const auto saw = [&](Visibility visibility) {
      return std::ranges::any_of(cells_[cell], [&](const Count& c) { return c.visibility() == visibility; });
    };
    return saw(Visibility::kSurface) && saw(Visibility::kHidden);
  }
  /// Whether the changes may be the outlines of static objects, from three cells of consecutive plate angles:
  /// the visibility then alternates less often in order of the plate angle than in order of time.
  bool may_be_static(const std::array<std::size_t, 3>& cells) const {
    std::size_t in_time = 0;
    std::vector<std::pair<double, Visibility>> by_angle;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      std::vector<Visibility> by_time;
      for (const Count& count : cells_[cells[k]]) {
        if (count.visibility() == Visibility::kNone) continue;
        by_time.push_back(count.visibility());
        by_angle.emplace_back(static_cast<double>(k) + count.place(), count.visibility());
      }
      in_time += alternations(by_time);
    }
    std::ranges::sort(by_angle);
    std::vector<Visibility> sorted;
    for (const auto& [place, visibility] : by_angle) sorted.push_back(visibility);
    return alternations(sorted) < in_time;
  }
  std::size_t hidden(std::size_t cell) const {
    std::size_t sum = 0;
    for (const Count& count : cells_[cell]) sum += count.hidden;
    return sum;
  }

 private:
  struct Count {
    std::uint32_t when = 0;
    std::uint16_t surface = 0, hidden = 0;
    double places = 0;  // their sum

    double place() const { return places / (surface + hidden); }

    Visibility visibility() const {
      constexpr double kAgree = 0.8;
      constexpr int kEnough = 2;
      const int all = surface + hidden;
      if (all < kEnough) return Visibility::kNone;
      if (surface >= kAgree * all) return Visibility::kSurface;
      return hidden >= kAgree * all ? Visibility::kHidden : Visibility::kNone;
    }
  };
  static std::size_t alternations(const std::vector<Visibility>& views) {
    std::size_t count = 0;
    for (std::size_t k = 1; k < views.size(); ++k) count += views[k] != views[k - 1] ? 1 : 0;
    return count;
  }

  std::size_t whens_;
  std::vector<std::vector<Count>> cells_;
};

ChangingDirections changing_among(const RepeatGrid& grid, const VisibilityGrid& visibility_grid,
                                  double beams) {
  std::vector<bool> does_change(grid.cells());
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    does_change[cell] = visibility_grid.changes(cell) && !visibility_grid.may_be_static(grid.along_row(cell));
  }
  constexpr std::ptrdiff_t kMaxOfNine = 6;
  ChangingDirections result;
  std::map<std::size_t, std::size_t> place;  // index of a cell among the changing ones
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    if (!does_change[cell]) continue;
    const auto alike =
        std::ranges::count_if(grid.around(cell), [&](std::size_t near) { return does_change[near]; });
    if (alike < kMaxOfNine) continue;
    place.emplace(cell, result.views.size());
    result.views.push_back(visibility_grid.views(cell));
    result.hidden += static_cast<double>(visibility_grid.hidden(cell)) / std::max(1.0, beams);
  }
  for (const auto& [cell, one] : place) {
    for (const std::size_t near : grid.around(cell)) {
      const auto other = place.find(near);
      if (other != place.end() && other->second > one) result.neighbours.emplace_back(one, other->second);
    }
  }
  return result;
}

/// Number of times at which two adjacent directions are occluded at once.
std::size_t hidden_together(const ChangingDirections& directions) {
  std::size_t count = 0;
  for (const auto& [one, other] : directions.neighbours) {
    const auto& first = directions.views[one];
    const auto& second = directions.views[other];
    for (std::size_t when = 0; when < first.size(); ++when) {
      count += first[when] == Visibility::kHidden && second[when] == Visibility::kHidden ? 1 : 0;
    }
  }
  return count;
}

void shuffle_times(statistics::RandomStream& random, std::vector<Visibility>& views) {
  std::vector<std::size_t> known;
  for (std::size_t when = 0; when < views.size(); ++when) {
    if (views[when] != Visibility::kNone) known.push_back(when);
  }
  for (std::size_t k = known.size(); k > 1; --k)
    std::swap(views[known[k - 1]], views[known[random.below(k)]]);
}

}  // namespace

ChangingDirections changing_directions(const Measurements& beams, const PlateTrajectory& plate,
                                       const BeamAssociation& association, double usual) {
  constexpr double kBefore = 0.3;                  // [m] minimum distance of the occluder from the surface
  constexpr double kSeenWithin = 4, kFarOff = 10;  // standard deviations
  const RepeatGrid grid(beams, plate);
  VisibilityGrid visibility_grid(grid);
  double ahead = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (association.ahead[i] == kNoSurface) continue;
    const auto observation = grid.observation(beams, i);
    if (!observation) continue;
    ahead += 1;
    const double error{association.error[i]};
    if (std::abs(error) < kSeenWithin * usual)
      visibility_grid.add(grid.cell(*observation), *observation, Visibility::kSurface);
    if (error < -std::max(kBefore, kFarOff * usual))
      visibility_grid.add(grid.cell(*observation), *observation, Visibility::kHidden);
  }
  return changing_among(grid, visibility_grid, ahead);
}

double p_value(const ChangingDirections& directions, std::uint64_t seed) {
  constexpr std::size_t kShuffles = 999;
  const auto together = [](const ChangingDirections& some) {
    return static_cast<double>(hidden_together(some));
  };
  statistics::RandomStream random(seed, "visibility");
  ChangingDirections shuffled = directions;
  const auto permuted = [&] {
    for (auto& views : shuffled.views) shuffle_times(random, views);
    return together(shuffled);
  };
  return statistics::monte_carlo_test(together(directions), kShuffles, permuted).p_value;
}

std::optional<Finding> moving(const ChangingDirections& directions, std::uint64_t seed) {
  constexpr std::size_t kFewDirections = 20;
  constexpr double kByChance = 0.002;
  constexpr double kMinShare = 5e-4;  // of the beams: a cat three metres away
  if (directions.views.size() < kFewDirections || directions.hidden < kMinShare) return std::nullopt;
  const double p = p_value(directions, seed);
  if (!(p < kByChance)) return std::nullopt;
  return Finding{.cause = "scene.moving",
                 .scope = "scene",
                 .parameters = {{.name = "hidden_share", .unit = "1", .value = directions.hidden},
                                {.name = "directions",
                                 .unit = "1",
                                 .value = static_cast<double>(directions.views.size())}},
                 .explained_fraction = kNotTested,
                 .p_value = p,
                 .confounded_with = {},
                 .gain = {},
                 .accepted = true};
}

}  // namespace crisp::diagnose
