// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/in_plane_calibration.hpp"

#include <algorithm>
#include <iterator>
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

/// The four steps, on a model that they move.
class InPlaneCalibration {
 public:
  InPlaneCalibration(SensorModel& model, const std::vector<std::size_t>& free, const Sample& sample,
                     Measure& measure, const InPlaneSettings& settings)
      : model_(model),
        free_(free),
        front_(in_plane(sample, settings.half_width, Half::kFront)),
        both_(in_plane(sample, settings.half_width, Half::kBoth)),
        measure_(measure),
        settings_(settings) {}

  void find_eta(std::size_t laser) {
    const Sample own = of_laser(front_, laser);
    const auto free = those_free({slot(model_, laser, kEta)});
    if (own.beams.size() < kFew || free.empty()) return;
    const double centre = model_.values()[static_cast<Eigen::Index>(free[0])];
    constexpr int kSteps = 25;  // to either side
    std::vector<double> grid;
    for (int i = -kSteps; i <= kSteps; ++i) grid.push_back(centre + settings_.range.eta * i / (kSteps + 1));
    search(model_, free[0], grid, false, own, measure_, settings_);
  }

  void find_tau_alpha(std::size_t laser) {
    const Sample own = of_laser(both_, laser);
    const auto free = those_free({slot(model_, laser, kTau), slot(model_, laser, kAlpha)});
    if (own.beams.size() < kFew || free.empty()) return;
    for (const double sigma : annealing(settings_.sigma_from, settings_.sigma_to)) {
      crispest(model_, own, free, measure_, sigma, settings_.range, settings_.minimiser);
    }
  }

  /// Against the laser whose λ stays where it is.
  void find_lambda(std::size_t laser, std::size_t reference) {
    const auto free = those_free({slot(model_, laser, kLambda)});
    if (free.empty() || of_laser(both_, laser).beams.size() < kFew ||
        of_laser(both_, reference).beams.size() < kFew) {
      return;
    }
    const Sample pair = select(both_, [&](std::size_t i) {
      return both_.beams.laser[i] == reference || both_.beams.laser[i] == laser;
    });
    constexpr int kSteps = 120;  // 3°: the valley at σ = 0.5 m is wider in any room
    std::vector<double> grid;
    for (int i = 0; i < kSteps; ++i) grid.push_back(2 * std::numbers::pi * i / kSteps);
    search(model_, free[0], grid, true, pair, measure_, settings_);
  }

  void find_geometry() {
    std::vector<std::size_t> geometry;
    for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
      const auto own =
          those_free({slot(model_, laser, kLambda), slot(model_, laser, kTau), slot(model_, laser, kAlpha)});
      if (of_laser(both_, laser).beams.size() >= kFew)
        geometry.insert(geometry.end(), own.begin(), own.end());
    }
    if (geometry.empty()) return;
    crispest(model_, both_, geometry, measure_, settings_.sigma_to, settings_.range, settings_.minimiser);
  }

  /// The first laser with a fixed λ.
  std::size_t reference() const {
    for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
      if (those_free({slot(model_, laser, kLambda)}).empty() && of_laser(both_, laser).beams.size() >= kFew) {
        return laser;
      }
    }
    return 0;
  }

 private:
  std::vector<std::size_t> those_free(const std::vector<std::size_t>& slots) const {
    std::vector<std::size_t> result;
    std::copy_if(slots.begin(), slots.end(), std::back_inserter(result),
                 [&](std::size_t s) { return std::find(free_.begin(), free_.end(), s) != free_.end(); });
    return result;
  }

  SensorModel& model_;
  const std::vector<std::size_t>& free_;
  Sample front_;
  Sample both_;
  Measure& measure_;
  const InPlaneSettings& settings_;
};

}  // namespace

void calibrate_in_plane(SensorModel& model, const std::vector<std::size_t>& free, const Sample& sample,
                        Measure& measure, const InPlaneSettings& settings) {
  InPlaneCalibration calibration(model, free, sample, measure, settings);
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) calibration.find_eta(laser);
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) calibration.find_tau_alpha(laser);
  const std::size_t reference = calibration.reference();
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) calibration.find_lambda(laser, reference);
  calibration.find_geometry();
}

}  // namespace crisp
