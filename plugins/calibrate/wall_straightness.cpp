// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/wall_straightness.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "pipeline/estimate/parameter_prior.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/quality/line_segmentation.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/calibrate/curve_minima.hpp"

namespace crisp::calibrate {

double wall_straightness(const SensorModel& model, const estimate::Sample& sample, double noise) {
  const Vectors points = estimate::place_all(model, sample.beams, *sample.plate);
  const auto running = quality::running_sums(points.view(), quality::by_azimuth(points.view()), noise);
  return quality::price_of(quality::straight_runs(running, {}), running, {});
}

bool turns_both_ways(const estimate::Sample& sample) {
  constexpr double kShare = 0.1;
  double forth = 0;
  double back = 0;
  for (const double time : sample.beams.time) {
    const double rate = sample.plate->at(time)->rate;
    (rate > 0 ? forth : back) += std::abs(rate);
  }
  return std::min(forth, back) > kShare * (forth + back);
}

double between_scans(const estimate::Sample& own) {
  std::vector<double> gaps(own.beams.time.size());
  std::adjacent_difference(own.beams.time.begin(), own.beams.time.end(), gaps.begin());
  return statistics::median_in_place(gaps);
}

std::optional<CompetingMinimum> minimize_wall_residual(SensorModel& model, std::size_t parameter,
                                                       const std::vector<double>& grid, bool circular,
                                                       const estimate::Sample& sample, double noise) {
  constexpr std::size_t kMaxMinima = 3;
  constexpr double kRoughly = 3;     // times the noise, during the global search
  constexpr double kOneMinimum = 3;  // steps: clutter makes dips near the minimum
  const auto price = [&](double by) {
    return [&, by](double value) {
      return wall_straightness(estimate::with_one(model, parameter, value), sample, by);
    };
  };
  auto places = local_minima(price(kRoughly * noise), grid, circular);
  places.resize(std::min(places.size(), kMaxMinima));
  if (places.empty()) return std::nullopt;
  const double step = grid[1] - grid[0];
  std::vector<LineMinimum> found;
  for (const double place : places) {
    found.push_back(bottom(price(noise), {.start = place,
                                          .step = step,
                                          .lower = place - 2 * step,
                                          .upper = place + 2 * step,
                                          .accuracy = 0.01}));
  }
  std::ranges::sort(found, {}, &LineMinimum::value);
  const LineMinimum best = found.front();
  model = estimate::with_one(model, parameter, best.at);
  const auto competitor = std::ranges::find_if(found, [&](const LineMinimum& other) {
    return between(other.at, best.at, circular) > kOneMinimum * step;
  });
  if (competitor == found.end()) return std::nullopt;
  return CompetingMinimum{
      .parameter = parameter, .at = competitor->at, .height = std::log(competitor->value / best.value) / 2};
}

}  // namespace crisp::calibrate
