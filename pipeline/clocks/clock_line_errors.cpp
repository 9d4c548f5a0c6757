// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/clocks/clock_line.hpp"
#include "pipeline/clocks/line_bias.hpp"
#include "pipeline/clocks/lower_hull.hpp"

namespace crisp::clocks {
namespace {

std::vector<double> block_minima(std::span<const Stamp> stamps, const ClockLine& line, std::size_t blocks) {
  std::vector<double> minima(blocks, HUGE_VAL);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    double& least = minima[i * blocks / stamps.size()];
    least = std::min(least, stamps[i].lead - line.lead(stamps[i].device));
  }
  return minima;
}

std::vector<double> paired_minima(const std::vector<double>& fine) {
  std::vector<double> coarse(fine.size() / 2);
  for (std::size_t i = 0; i < coarse.size(); ++i) coarse[i] = std::min(fine[2 * i], fine[2 * i + 1]);
  return coarse;
}

/// A block's typical least delay. The two blocks that support the line carry no information, and a quarter of
/// the blocks may be disturbed.
double typical(std::vector<double> minima) {
  std::sort(minima.begin(), minima.end());
  const std::size_t end = minima.size() - (minima.size() - 2) / 4;
  double sum = 0;
  for (std::size_t i = 2; i < end; ++i) sum += minima[i];
  constexpr double kLowerThreeQuarters = 0.5945;  // their mean over the whole mean, of an exponential law
  return sum / static_cast<double>(end - 2) / kLowerThreeQuarters;
}

constexpr std::size_t kBlocks = 32;

/// Whether there are enough stamps to estimate the line's error from the least delays of blocks.
bool has_blocks(std::span<const Stamp> stamps) { return stamps.size() >= 2 * kBlocks; }

/// Expected height of the lowest of all stamps above a line of known slope. From blocks to half as many,
/// the least delay falls by a power that depends on the delays' distribution; extrapolated to one block.
double lowest_delay(std::span<const Stamp> stamps, const ClockLine& line) {
  constexpr double kUsualDelay = 1e-3;  // [s] assumed where there are too few stamps
  if (stamps.size() < 4) return kUsualDelay;
  if (!has_blocks(stamps)) return typical(block_minima(stamps, line, stamps.size()));
  const auto fine = block_minima(stamps, line, kBlocks);
  const auto middle = paired_minima(fine);
  const double of_fine = typical(fine);
  const double of_middle = typical(middle);
  const double of_coarse = typical(paired_minima(middle));
  if (of_coarse <= 0) return 0;
  const double power = std::clamp(std::log2(of_fine / of_coarse) / 2, 0.0, 1.2);
  return std::cbrt(of_fine * of_middle * of_coarse) * std::pow(kBlocks / 2, -power);
}

/// The weight exp(height/scale) of all slopes in an interval, and its moments about an origin.
struct Moments {
  double mass = 0;
  double second = 0;

  /// The weight falls from `at_edge` at `edge` in direction `away` (±1) with `rate`, over `length`.
  void add_falling(double at_edge, double edge, double away, double rate, double length) {
    const double q = rate * length;
    double s0 = length;
    double s1 = length * length / 2;
    double s2 = length * length * length / 3;
    if (q > 1e-3) {
      const double rest = std::exp(-q);
      s0 = (1 - rest) / rate;
      s1 = (1 - rest * (1 + q)) / (rate * rate);
      s2 = (2 - rest * (q * q + 2 * q + 2)) / (rate * rate * rate);
    }
    mass += at_edge * s0;
    second += at_edge * (edge * edge * s0 + 2 * edge * away * s1 + s2);
  }
};

/// The spread of all lines below the stamps, each weighted by how probable it makes it that no stamp lies
/// between it and the hull: exp(height at the center / scale). For a slope, the highest line is a support of
/// the hull; its height is linear in the slope as long as it touches the same vertex.
double slope_spread(std::span<const Stamp> vertices, const ClockLine& line, double scale) {
  const auto slope_before = [&](std::size_t i) {
    const double rise = vertices[i].lead - vertices[i - 1].lead;
    return std::clamp(rise / (vertices[i].device - vertices[i - 1].device), -kMaxSkew, kMaxSkew);
  };
  struct Piece {
    double height;
    double edge;
    double away;
    double rate;
    double length;
  };
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double low = i == 0 ? -kMaxSkew : slope_before(i);
    const double high = i + 1 == vertices.size() ? kMaxSkew : slope_before(i + 1);
    if (low >= high) continue;
    const double ahead = line.center - vertices[i].device;
    const double edge = ahead > 0 ? high : low;
    const double height = vertices[i].lead + edge * ahead - line.at_center;
    pieces.push_back(
        {height, edge - line.slope, ahead > 0 ? -1.0 : 1.0, std::abs(ahead) / scale, high - low});
  }
  // Weights are relative. The highest line is the fitted one, but for rounding, which stamps of years apart
  // make large: all weights but its own may be nothing.
  double highest = -HUGE_VAL;
  for (const Piece& piece : pieces) highest = std::max(highest, piece.height);
  Moments moments;
  for (const Piece& piece : pieces) {
    moments.add_falling(std::exp((piece.height - highest) / scale), piece.edge, piece.away, piece.rate,
                        piece.length);
  }
  if (!(moments.mass > 0)) return kMaxSkew;
  return std::sqrt(moments.second / moments.mass);
}

}  // namespace

LineErrors errors_of_line(std::span<const Stamp> stamps, const ClockLine& line, double quantum) {
  const double scale = std::max(lowest_delay(stamps, line), quantum);
  LowerHull hull;
  for (const auto& stamp : stamps) hull.add(stamp);
  const LineBias bias = estimate_line_bias(stamps, line, quantum);
  return {.bias = bias.mean,
          .at_center = has_blocks(stamps) ? std::max(bias.std_error, scale) : bias.std_error,
          .slope = slope_spread(hull.vertices(), line, scale)};
}

}  // namespace crisp::clocks
