// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/scene_repeat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace crisp::estimate {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMax = 0.5;  // [m] by which ranges count as different

struct Comparison {
  double angle = 0;  ///< [rad] of the plate
  double range = 0;  ///< [m]
};

/// Ranges of some beams of each laser by the plate's angle, for comparison.
using Comparisons = std::vector<std::vector<Comparison>>;

Comparisons comparisons_of(const Sample& sample) {
  constexpr std::size_t kBeams = 16;  // of each laser, spread over its field of view
  const Measurements& beams = sample.beams;
  std::map<std::uint16_t, std::uint16_t> last;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    auto& most = last[beams.laser[i]];
    most = std::max(most, beams.beam[i]);
  }
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::vector<Comparison>> by_beam;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t step = std::max<std::size_t>(1, (last[beams.laser[i]] + 1U) / kBeams);
    if (beams.beam[i] % step != step / 2) continue;
    const auto plate = sample.plate->at(beams.time[i]);
    if (plate) by_beam[{beams.laser[i], beams.beam[i]}].push_back({plate->angle, beams.range[i]});
  }
  Comparisons comparisons;
  for (auto& [beam, own] : by_beam) {
    std::ranges::sort(own, {}, &Comparison::angle);
    comparisons.push_back(std::move(own));
  }
  return comparisons;
}

struct Miss {
  double sum = 0;
  std::size_t pairs = 0;
};

constexpr double kNear = 0.04;   // [rad] farther beams are not compared
constexpr double kClose = 0.01;  // [rad] a scene hardly differs between such

/// Compares what was seen with what is seen a period later, at the nearest angle.
void add_misses(const std::vector<Comparison>& comparisons, double period, double farthest, Miss& miss) {
  std::size_t next = 0;
  for (const Comparison& comparison : comparisons) {
    const double then = comparison.angle + period;
    while (next + 1 < comparisons.size() &&
           std::abs(comparisons[next + 1].angle - then) <= std::abs(comparisons[next].angle - then)) {
      ++next;
    }
    if (std::abs(comparisons[next].angle - then) > farthest) continue;
    miss.sum += std::min(kMax, std::abs(comparisons[next].range - comparison.range));
    ++miss.pairs;
  }
}

/// [m] Mean difference after a period; infinite where too few scans have a counterpart.
double miss_of(const Comparisons& comparisons, double period, double farthest = kNear) {
  constexpr std::size_t kFew = 200;
  Miss miss;
  for (const auto& own : comparisons) add_misses(own, period, farthest, miss);
  return miss.pairs < kFew ? HUGE_VAL : miss.sum / static_cast<double>(miss.pairs);
}

/// [m] Median of the mean differences after angles that are near no simple fraction or multiple of a turn.
double miss_elsewhere(const Comparisons& comparisons) {
  std::array turns = {0.38, 0.43, 0.59, 0.61, 0.71, 0.82, 1.38};
  std::ranges::transform(turns, turns.begin(),
                         [&](double share) { return miss_of(comparisons, share * kTurn); });
  std::ranges::sort(turns);
  return turns[turns.size() / 2];
}

}  // namespace

std::optional<SceneRepeat> scene_repeat(const Sample& sample) {
  constexpr double kMinTurns = 1.2;
  constexpr double kAround = 0.08;
  constexpr double kStep = 0.002;
  constexpr std::array kFactors = {0.25, 1.0 / 3, 0.5, 1.0, 2.0, 3.0, 4.0};  // ascending
  constexpr double kAsGood = 1.15, kBesides = 0.01;                          // [m]
  if (sample.beams.size() == 0 || turned(sample) < kMinTurns * kTurn) return std::nullopt;
  const Comparisons comparisons = comparisons_of(sample);
  const double at_2pi = miss_of(comparisons, kTurn);
  if (!std::isfinite(at_2pi)) return std::nullopt;
  const double close = miss_of(comparisons, kTurn, kClose);
  const double close_at_2pi = std::isfinite(close) ? close : 0;
  const double elsewhere = miss_elsewhere(comparisons);
  if (!std::isfinite(elsewhere)) return std::nullopt;  // some angles recur by chance, at an even rate
  std::vector<SceneRepeat> nearest;                    // one for each factor
  for (const double factor : kFactors) {
    SceneRepeat best{.angle = factor * kTurn,
                     .miss = miss_of(comparisons, factor * kTurn),
                     .at_2pi = at_2pi,
                     .close_at_2pi = close_at_2pi,
                     .elsewhere = elsewhere};
    for (double share = 1 - kAround; share < 1 + kAround + kStep / 2; share += kStep) {
      const double miss = miss_of(comparisons, factor * share * kTurn);
      if (miss >= best.miss) continue;
      best.angle = factor * share * kTurn;
      best.miss = miss;
    }
    nearest.push_back(best);
  }
  // After two turns all is the same again: of periods that are as good the shortest is the turn.
  const double least = std::ranges::min(nearest, {}, &SceneRepeat::miss).miss;
  return *std::ranges::find_if(
      nearest, [&](const SceneRepeat& period) { return period.miss <= kAsGood * least + kBesides; });
}

bool contradicts_counts(const SceneRepeat& period) {
  constexpr double kClearly = 0.6;  // of the mean difference
  constexpr double kMin = 0.03;     // [m] by which it is smaller
  const double share = period.angle / kTurn;
  const bool is_part = share < 1 / 1.5;
  const bool is_multiple = share > 1.5;
  // After a rig's turn that is a part of one, the plate looks elsewhere. If the scene nearly repeats then,
  // the encoder has slipped, and the angle after which it repeats better is one where slips happen to cancel.
  constexpr double kRepeats = 0.5;
  if (is_multiple && period.at_2pi < kRepeats * period.elsewhere) return false;
  // At a constant rate beams may lie between those of the turn before, and on those of some turns before.
  const double at_2pi = is_multiple ? period.close_at_2pi : period.at_2pi;
  // Where a scene repeats after no angle, one is as good as another.
  if (is_part) return period.miss < kClearly * period.elsewhere;
  return std::abs(share - 1) > 0.003 && period.miss < kClearly * at_2pi && period.miss < at_2pi - kMin;
}

std::string counts_caveat(const SceneRepeat& period) {
  const double turns = period.angle / kTurn;
  return fmt::format(
      "the scene repeats after {:.3f} turns of the plate, as the rig counts them: ranges there differ by {:.0f} mm, and by {:.0f} mm after one turn. The rig's plate.counts_per_revolution is wrong: multiply it by {:.3f}",
      turns, period.miss * 1e3, period.at_2pi * 1e3, turns);
}

}  // namespace crisp::estimate
