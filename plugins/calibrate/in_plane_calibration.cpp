// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/in_plane_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "plugins/calibrate/cloud_objective.hpp"

namespace crisp {
namespace {

constexpr std::size_t kFew = 20;  // beams: with fewer there is nothing to align

Sample of_laser(const Sample& sample, std::size_t laser) {
  return select(sample, [&](std::size_t i) { return sample.beams.laser[i] == laser; });
}

std::size_t slot(const SensorModel& model, std::size_t laser, std::size_t which) {
  return model.chain(laser).slots[which];
}
constexpr std::size_t kLambda = 0;
constexpr std::size_t kTau = 1;
constexpr std::size_t kAlpha = 2;
constexpr std::size_t kEta = 3;

/// Values of one parameter at which the cost is lower than at both neighbours, the lowest first.
std::vector<double> valleys(SensorModel model, std::size_t parameter, const std::vector<double>& grid,
                            bool circular, const Sample& sample, Measure& measure, double sigma) {
  std::vector<double> cost;
  for (const double value : grid) {
    Eigen::VectorXd values = model.values();
    values[static_cast<Eigen::Index>(parameter)] = value;
    model.set_values(values);
    cost.push_back(model_quality(model, sample, measure, sigma));
  }
  std::vector<std::size_t> found;
  const std::size_t n = grid.size();
  for (std::size_t i = 0; i < n; ++i) {
    const bool below_left = i > 0 ? cost[i] <= cost[i - 1] : !circular || cost[i] <= cost[n - 1];
    const bool below_right = i + 1 < n ? cost[i] < cost[i + 1] : !circular || cost[i] < cost[0];
    if (below_left && below_right) found.push_back(i);
  }
  std::sort(found.begin(), found.end(), [&](auto a, auto b) { return cost[a] < cost[b]; });
  std::vector<double> values;
  for (const auto i : found) values.push_back(grid[i]);
  return values;
}

/// Follows the few lowest valleys of one parameter downhill while σ narrows, and keeps the crispest end.
void search(SensorModel& model, std::size_t parameter, const std::vector<double>& grid, bool circular,
            const Sample& sample, Measure& measure, const InPlaneSettings& settings) {
  auto starts = valleys(model, parameter, grid, circular, sample, measure, settings.sigma_from);
  constexpr std::size_t kValleys = 4;
  starts.resize(std::min(starts.size(), kValleys));
  SensorModel best = model;
  double lowest = std::numeric_limits<double>::infinity();
  for (const double start : starts) {
    SensorModel trial = model;
    Eigen::VectorXd values = trial.values();
    values[static_cast<Eigen::Index>(parameter)] = start;
    trial.set_values(values);
    double value = 0;
    for (const double sigma : annealing(settings.sigma_from, settings.sigma_to)) {
      value = crispest(trial, sample, {parameter}, measure, sigma, settings.range, settings.minimiser).value;
    }
    if (value < lowest) {
      lowest = value;
      best = trial;
    }
  }
  model = best;
}

void find_eta(SensorModel& model, std::size_t laser, const Sample& front, Measure& measure,
              const InPlaneSettings& settings) {
  const Sample own = of_laser(front, laser);
  if (own.beams.size() < kFew) return;
  const auto parameter = slot(model, laser, kEta);
  const double centre = model.values()[static_cast<Eigen::Index>(parameter)];
  constexpr int kSteps = 25;  // to either side
  std::vector<double> grid;
  for (int i = -kSteps; i <= kSteps; ++i) grid.push_back(centre + settings.range.eta * i / (kSteps + 1));
  search(model, parameter, grid, false, own, measure, settings);
}

void find_tau_alpha(SensorModel& model, std::size_t laser, const Sample& both, Measure& measure,
                    const InPlaneSettings& settings) {
  const Sample own = of_laser(both, laser);
  if (own.beams.size() < kFew) return;
  const std::vector<std::size_t> free = {slot(model, laser, kTau), slot(model, laser, kAlpha)};
  for (const double sigma : annealing(settings.sigma_from, settings.sigma_to)) {
    crispest(model, own, free, measure, sigma, settings.range, settings.minimiser);
  }
}

void find_lambda(SensorModel& model, std::size_t laser, const Sample& both, Measure& measure,
                 const InPlaneSettings& settings) {
  const Sample pair =
      select(both, [&](std::size_t i) { return both.beams.laser[i] == 0 || both.beams.laser[i] == laser; });
  if (of_laser(pair, laser).beams.size() < kFew || of_laser(pair, 0).beams.size() < kFew) return;
  constexpr int kSteps = 120;  // 3°: the valley at σ = 0.5 m is wider in any room
  std::vector<double> grid;
  for (int i = 0; i < kSteps; ++i) grid.push_back(2 * std::numbers::pi * i / kSteps);
  search(model, slot(model, laser, kLambda), grid, true, pair, measure, settings);
}

}  // namespace

void calibrate_in_plane(SensorModel& model, const Sample& sample, Measure& measure,
                        const InPlaneSettings& settings) {
  const Sample front = in_plane(sample, settings.half_width, Half::kFront);
  const Sample both = in_plane(sample, settings.half_width, Half::kBoth);
  if (settings.eta) {
    for (std::size_t laser = 0; laser < model.lasers(); ++laser)
      find_eta(model, laser, front, measure, settings);
  }
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    find_tau_alpha(model, laser, both, measure, settings);
  }
  std::vector<std::size_t> geometry;
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    if (laser > 0) {
      find_lambda(model, laser, both, measure, settings);
      geometry.push_back(slot(model, laser, kLambda));
    }
    geometry.push_back(slot(model, laser, kTau));
    geometry.push_back(slot(model, laser, kAlpha));
  }
  if (both.beams.size() < kFew) return;
  crispest(model, both, geometry, measure, settings.sigma_to, settings.range, settings.minimiser);
}

}  // namespace crisp
