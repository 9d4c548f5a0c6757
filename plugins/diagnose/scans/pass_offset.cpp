// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/statistics/bootstrap.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/scans/homogeneity_test.hpp"
#include "plugins/diagnose/scans/passes.hpp"

namespace crisp::diagnose {
namespace {

constexpr int kAroundLeast = 4;  // [steps] support of the cubic fit on either side
constexpr std::size_t kDrawsOfBlocks = 300;

using Curve = std::vector<std::pair<double, double>>;  // [rad] difference in angle, [m²] variance

std::vector<PassBlock::Bin> sum_of(const PassComparison& comparison, std::span<const std::size_t> blocks) {
  std::vector<PassBlock::Bin> sums(2 * kReach + 1);
  for (const auto b : blocks) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto& bin = comparison.blocks[b].bins[i];
      sums[i].n += bin.n;
      sums[i].by += bin.by;
      sums[i].error += bin.error;
      sums[i].squares += bin.squares;
    }
  }
  return sums;
}

/// Minimum of a cubic fitted through the bins around a shift. Weights fall off with distance, so that the
/// estimate is continuous in the centre.
double least_around(const Curve& curve, double centre, double step) {
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d values = Eigen::Vector4d::Zero();
  for (const auto& [by, variance] : curve) {
    const double x = (by - centre) / step;
    const double weight = statistics::biweight(x / (kAroundLeast + 1));
    const Eigen::Vector4d powers(1, x, x * x, x * x * x);
    squares += weight * powers * powers.transpose();
    values += weight * variance * powers;
  }
  const Eigen::Vector4d cubic = squares.ldlt().solve(values);
  const double root = cubic(2) * cubic(2) - 3 * cubic(1) * cubic(3);
  if (!(cubic(2) > 0) || !(root >= 0)) return std::nan("");
  return centre - cubic(1) / (cubic(2) + std::sqrt(root)) * step;
}

Curve variances(const PassComparison& comparison, std::span<const std::size_t> blocks) {
  constexpr double kMin = 200;  // beams
  Curve curve;
  for (const auto& bin : sum_of(comparison, blocks)) {
    if (bin.n < kMin) continue;
    const double mean = bin.error / bin.n;
    curve.emplace_back(bin.by / bin.n, bin.squares / bin.n - mean * mean);
  }
  return curve;
}

std::vector<std::size_t> every(const PassComparison& comparison, const auto& requested) {
  std::vector<std::size_t> some;
  for (std::size_t b = 0; b < comparison.blocks.size(); ++b) {
    if (requested(comparison.blocks[b])) some.push_back(b);
  }
  return some;
}

double error_of_shift(const PassComparison& comparison, const std::vector<std::size_t>& blocks,
                      std::uint64_t seed) {
  return statistics::bootstrap(blocks.size(), 1, seed, kDrawsOfBlocks,
                               [&](const std::vector<std::size_t>& picked) {
                                 std::vector<std::size_t> drawn;
                                 for (const auto i : picked) drawn.push_back(blocks[i]);
                                 return shift_between(comparison, drawn);
                               })
      .std_error;
}

std::pair<double, double> shift_with_error(const PassComparison& comparison,
                                           const std::vector<std::size_t>& blocks, std::uint64_t seed) {
  return {shift_between(comparison, blocks), error_of_shift(comparison, blocks, seed)};
}

/// Blocks of every other part of the angles.
std::vector<std::size_t> half_of(const PassComparison& comparison, bool odd) {
  return every(comparison, [&](const PassBlock& block) { return (block.angle_part % 2 == 1) == odd; });
}

/// Shifts in quarters of the angles or of the beams.
std::vector<std::pair<double, double>> in_quarters(const PassComparison& comparison, bool of_angles,
                                                   std::uint64_t seed) {
  constexpr std::size_t kQuarters = 4;
  std::vector<std::pair<double, double>> all;
  for (std::size_t q = 0; q < kQuarters; ++q) {
    const auto blocks = every(comparison, [&](const PassBlock& block) {
      return of_angles ? block.angle_part * kQuarters / kAngleParts == q
                       : block.beam_part * kQuarters / kBeamParts == q;
    });
    all.push_back(shift_with_error(comparison, blocks, seed));
  }
  return all;
}

/// Homogeneity test of the shifts in parts of the passes.
double constancy(const std::vector<ValueWithError>& values) {
  return homogeneity_test(values, Level::kMean, kPassBlocks / values.size()).p_value;
}

Gain gain_of(const PassComparison& comparison, std::uint64_t seed) {
  const auto fitted = half_of(comparison, false);
  const auto held_out = half_of(comparison, true);
  const double shift = shift_between(comparison, fitted);
  const auto change = [&](const std::vector<std::size_t>& blocks) {
    return std::sqrt(variance_at(comparison, blocks, shift)) - std::sqrt(variance_at(comparison, blocks, 0));
  };
  Gain gain{.metric = "difference between passes: standard deviation",
            .unit = "m",
            .before = std::sqrt(variance_at(comparison, held_out, 0)),
            .after = std::sqrt(variance_at(comparison, held_out, shift))};
  gain.ci95 = statistics::bootstrap(held_out.size(), 1, seed, kDrawsOfBlocks,
                                    [&](const std::vector<std::size_t>& picked) {
                                      std::vector<std::size_t> drawn;
                                      for (const auto i : picked) drawn.push_back(held_out[i]);
                                      return change(drawn);
                                    })
                  .ci95;
  return gain;
}

}  // namespace

double shift_between(const PassComparison& comparison, std::span<const std::size_t> blocks) {
  const Curve curve = variances(comparison, blocks);
  if (curve.size() < 2 * kAroundLeast + 1) return std::nan("");
  std::size_t least = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (curve[i].second < curve[least].second) least = i;
  }
  if (least < kAroundLeast || least + kAroundLeast >= curve.size()) return std::nan("");
  constexpr int kMaxRounds = 20;
  constexpr double kSettled = 1e-4;  // [steps]
  double centre = curve[least].first;
  for (int round = 0; round < kMaxRounds; ++round) {
    const double next = least_around(curve, centre, comparison.step);
    if (!(std::abs(next - curve[least].first) < kAroundLeast * comparison.step)) return std::nan("");
    const bool settled = std::abs(next - centre) < kSettled * comparison.step;
    centre = next;
    if (settled) break;
  }
  return centre;
}

double variance_at(const PassComparison& comparison, std::span<const std::size_t> blocks, double shift) {
  const Curve curve = variances(comparison, blocks);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (shift > curve[i].first || shift < curve[i - 1].first) continue;
    const double on = (shift - curve[i - 1].first) / (curve[i].first - curve[i - 1].first);
    return (1 - on) * curve[i - 1].second + on * curve[i].second;
  }
  return std::nan("");
}

PassOffset find_shift(const Pass& up, const Pass& down, std::uint64_t seed) {
  const auto comparison = compare_passes(up, down);
  const auto all = every(comparison, [](const PassBlock&) { return true; });
  PassOffset found{.shift = shift_between(comparison, all)};
  found.std_error = error_of_shift(comparison, all, seed);
  found.by_angle = in_quarters(comparison, true, seed);
  found.by_beam = in_quarters(comparison, false, seed);
  found.fitted = shift_with_error(comparison, half_of(comparison, false), seed);
  found.held_out = shift_with_error(comparison, half_of(comparison, true), seed);
  found.constant_p = std::min(1.0, 2 * std::min(constancy(found.by_angle), constancy(found.by_beam)));
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& bin : sum_of(comparison, all)) {
    if (!(bin.n > 0) || std::abs(bin.by / bin.n - found.shift) > nearest) continue;
    nearest = std::abs(bin.by / bin.n - found.shift);
    found.offset = bin.error / bin.n;
  }
  found.gain = gain_of(comparison, seed);
  double products = 0;
  double squares = 0;
  for (const double steps : {-2.0, -1.0, -0.5, 0.5, 1.0, 2.0}) {
    const double injected = steps * comparison.step;
    const auto moved = compare_passes(up, down, injected);
    const double recovered = found.shift - shift_between(moved, all);
    found.recovered_shifts.emplace_back(injected, recovered);
    products += injected * recovered;
    squares += injected * injected;
  }
  found.recovery_slope = products / squares;
  return found;
}

}  // namespace crisp::diagnose
