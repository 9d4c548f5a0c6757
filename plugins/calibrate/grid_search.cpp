// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/grid_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/curve_minima.hpp"

namespace crisp::calibrate {
namespace {

/// The cost over one parameter.
Curve cost_over(const SensorModel& model, std::size_t parameter, const estimate::Sample& sample,
                Measure& measure, double sigma) {
  return [&, parameter, sigma](double value) {
    return model_quality(estimate::with_one(model, parameter, value), sample, measure, sigma);
  };
}

constexpr double kFine = 1e-3;   // of a step that displaces the cloud by σ
constexpr double kRough = 0.03;  // from where a narrower kernel goes on

/// Leaves one of bottoms that are nearer to one another than `same`, the first.
void drop_doubles(std::vector<LineMinimum>& bottoms, double same, bool circular) {
  std::vector<LineMinimum> single;
  for (const LineMinimum& bottom : bottoms) {
    const bool is_new = std::ranges::all_of(
        single, [&](const LineMinimum& other) { return between(bottom.at, other.at, circular) > same; });
    if (is_new) single.push_back(bottom);
  }
  bottoms = std::move(single);
}

}  // namespace

double between(double a, double b, bool circular) {
  return std::abs(circular ? std::remainder(a - b, 2 * std::numbers::pi) : a - b);
}

std::vector<double> grid_around(double centre, double reach, int steps) {
  std::vector<double> grid;
  for (int i = -steps; i <= steps; ++i) grid.push_back(centre + reach * i / steps);
  return grid;
}

std::vector<double> grid_of_step(double centre, double reach, double step) {
  return grid_around(centre, reach, std::max(2, static_cast<int>(std::ceil(reach / step))));
}

std::vector<double> grid_on_circle(int steps) {
  std::vector<double> grid;
  for (int i = 0; i < steps; ++i) grid.push_back(2 * std::numbers::pi * i / steps);
  return grid;
}

std::optional<CompetingMinimum> multistart_search(SensorModel& model, std::size_t parameter,
                                                  const std::vector<double>& grid, bool circular,
                                                  const estimate::Sample& sample, Measure& measure,
                                                  const estimate::ParameterPrior& range,
                                                  const Narrowing& sigma) {
  constexpr std::size_t kMaxMinima = 4;
  constexpr double kSame = 0.1;          // of a step: ends so near to one another are one
  constexpr std::size_t kFinalists = 2;  // under the narrowest kernel, which uses all beams
  const auto sigmas = annealing(sigma.from, sigma.to);
  std::vector<estimate::Sample> samples;
  for (const double width : sigmas) samples.push_back(estimate::thin_for(width, sample));
  auto starts =
      local_minima(cost_over(model, parameter, samples.front(), measure, sigma.from), grid, circular);
  starts.resize(std::min(starts.size(), kMaxMinima));
  const double margin = circular ? std::numbers::pi : grid[1] - grid[0];
  const auto step_at = [&](double place, std::size_t k) {
    const SensorModel there = estimate::with_one(model, parameter, place);
    return std::abs(search_basis(there, samples[k], {parameter}, range, sigmas[k])(0, 0));
  };
  const auto follow = [&](double start, std::size_t k) {
    return bottom(cost_over(model, parameter, samples[k], measure, sigmas[k]),
                  {.start = start,
                   .step = step_at(start, k),
                   .lower = grid.front() - margin,
                   .upper = grid.back() + margin,
                   .accuracy = k + 1 == sigmas.size() ? kFine : kRough});
  };
  std::vector<LineMinimum> bottoms;
  for (const double start : starts) bottoms.push_back({.at = start, .value = 0});
  if (bottoms.empty()) return std::nullopt;
  for (std::size_t k = 0; k < sigmas.size(); ++k) {
    for (LineMinimum& found : bottoms) found = follow(found.at, k);
    std::ranges::sort(bottoms, {}, &LineMinimum::value);
    drop_doubles(bottoms, kSame * step_at(bottoms.front().at, k), circular);
    if (k + 2 == sigmas.size()) bottoms.resize(std::min(bottoms.size(), kFinalists));
  }
  const LineMinimum best = bottoms.front();
  model = estimate::with_one(model, parameter, best.at);
  const bool has_competitor =
      bottoms.size() > 1 && between(bottoms[1].at, best.at, circular) > step_at(best.at, sigmas.size() - 1);
  if (!has_competitor) return std::nullopt;
  return CompetingMinimum{
      .parameter = parameter, .at = bottoms[1].at, .height = bottoms[1].value - best.value};
}

}  // namespace crisp::calibrate
