// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/passes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kNoEdgeOnTheWay = 0.15;  // [m]

double median_step(const Pass& pass) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < pass.scans.size(); ++i) {
    const double step = pass.scans[i].angle - pass.scans[i - 1].angle;
    if (step > 0) steps.push_back(step);
  }
  return statistics::median_in_place(steps);
}

/// [rad] Fractional step between the angle grids of the upward and the downward pass, at most half a step.
/// Bins centred on it contain angle differences of one size only.
double between_steps(const Pass& up, const Pass& down, double injected, double step) {
  std::complex<double> sum;
  for (const PassScan& scan : down.scans) {
    const auto next = std::lower_bound(up.scans.begin(), up.scans.end(), scan.angle + injected,
                                       [](const PassScan& s, double limit) { return s.angle < limit; });
    if (next == up.scans.end()) continue;
    sum += std::polar(1.0, 2 * std::numbers::pi * (next->angle - scan.angle - injected) / step);
  }
  return std::arg(sum) / (2 * std::numbers::pi) * step;
}

/// Scans of the upward pass that are compared with one of the downward pass, by bin of the angle difference.
struct PassWindow {
  std::vector<const std::vector<float>*> ranges;
  std::vector<double> by;  ///< [rad]
  std::vector<std::size_t> bins;
};

PassWindow window_around(const Pass& up, double angle, double step, double between) {
  const double reach = (kReach + 0.5) * step;
  const double middle = angle + between;
  PassWindow window;
  auto scan = std::lower_bound(up.scans.begin(), up.scans.end(), middle - reach,
                               [](const PassScan& s, double limit) { return s.angle < limit; });
  for (; scan != up.scans.end() && scan->angle < middle + reach; ++scan) {
    const double by = scan->angle - angle;
    const long bin = std::lround((by - between) / step) + kReach;
    if (bin < 0 || bin > 2 * kReach) continue;
    window.ranges.push_back(scan->ranges);
    window.by.push_back(by);
    window.bins.push_back(static_cast<std::size_t>(bin));
  }
  return window;
}

bool is_smooth(const PassWindow& window, std::size_t k, double range) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  double sum = 0;
  for (const auto* ranges : window.ranges) {
    if (k >= ranges->size() || !((*ranges)[k] > 0)) return false;
    const auto r = static_cast<double>((*ranges)[k]);
    least = std::min(least, r);
    most = std::max(most, r);
    sum += r;
  }
  return most - least < kNoEdgeOnTheWay &&
         std::abs(range - sum / static_cast<double>(window.ranges.size())) < kNoEdgeOnTheWay;
}

}  // namespace

std::vector<Pass> find_passes(const ScanSeries& series, const PlateTrajectory& actuator, double shortest) {
  std::vector<Pass> passes;
  Pass now;
  const auto close = [&] {
    if (now.scans.size() > 1 && std::abs(now.scans.back().angle - now.scans.front().angle) >= shortest) {
      if (!now.up) std::reverse(now.scans.begin(), now.scans.end());
      passes.push_back(now);
    }
    now = {};
  };
  for (const auto& scan : series.scans()) {
    const auto state = actuator.at(scan.receipt);
    if (!state) continue;
    const PassScan next{state->angle, &scan.ranges()};
    if (!now.scans.empty()) {
      const double by = next.angle - now.scans.back().angle;
      if (by == 0) continue;  // stationary
      const bool turns = now.scans.size() > 1 && (by > 0) != now.up;
      if (turns) close();
      if (now.scans.size() == 1) now.up = by > 0;
    }
    now.scans.push_back(next);
  }
  close();
  return passes;
}

PassComparison compare_passes(const Pass& up, const Pass& down, double injected) {
  PassComparison comparison{.step = median_step(up)};
  comparison.blocks.resize(kAngleParts * kBeamParts);
  for (std::size_t b = 0; b < comparison.blocks.size(); ++b) {
    comparison.blocks[b] = {.angle_part = b / kBeamParts, .beam_part = b % kBeamParts, .bins = {}};
    comparison.blocks[b].bins.resize(2 * kReach + 1);
  }
  const double between = between_steps(up, down, injected, comparison.step);
  for (std::size_t i = 0; i < down.scans.size(); ++i) {
    const auto& ranges = *down.scans[i].ranges;
    const auto window = window_around(up, down.scans[i].angle + injected, comparison.step, between);
    if (window.ranges.size() < 2 * kReach) continue;
    const std::size_t angle_part = i * kAngleParts / down.scans.size();
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const auto range = static_cast<double>(ranges[k]);
      if (!(range > 0) || !is_smooth(window, k, range)) continue;
      auto& block = comparison.blocks[angle_part * kBeamParts + k * kBeamParts / ranges.size()];
      ++comparison.beams;
      for (std::size_t w = 0; w < window.ranges.size(); ++w) {
        const double error = range - static_cast<double>((*window.ranges[w])[k]);
        auto& bin = block.bins[window.bins[w]];
        bin.n += 1;
        bin.by += window.by[w];
        bin.error += error;
        bin.squares += error * error;
      }
    }
  }
  return comparison;
}

}  // namespace crisp::diagnose
