// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/in_plane_calibration.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>

#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/valleys.hpp"

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

/// The cost over one parameter.
Curve cost_over(const SensorModel& model, std::size_t parameter, const Sample& sample, Measure& measure,
                double sigma) {
  return [&, parameter, sigma](double value) {
    return model_quality(with(model, {parameter}, Eigen::VectorXd::Constant(1, value)), sample, measure,
                         sigma);
  };
}

/// Follows the few lowest valleys of one parameter downhill while σ narrows, and keeps the crispest end.
void search(SensorModel& model, std::size_t parameter, const std::vector<double>& grid, bool circular,
            const Sample& sample, Measure& measure, const InPlaneSettings& settings) {
  constexpr std::size_t kValleys = 4;
  auto starts = valleys(cost_over(model, parameter, sample, measure, settings.sigma_from), grid, circular);
  starts.resize(std::min(starts.size(), kValleys));
  const double margin = circular ? std::numbers::pi : grid[1] - grid[0];
  Bottom best{.at = picked(model, {parameter})[0], .value = std::numeric_limits<double>::infinity()};
  for (const double start : starts) {
    Bottom found{.at = start, .value = 0};
    for (const double sigma : annealing(settings.sigma_from, settings.sigma_to)) {
      const SensorModel there = with(model, {parameter}, Eigen::VectorXd::Constant(1, found.at));
      const double step = search_basis(there, sample, {parameter}, settings.range, sigma)(0, 0);
      found = bottom(cost_over(model, parameter, sample, measure, sigma), found.at, std::abs(step),
                     grid.front() - margin, grid.back() + margin);
    }
    if (found.value < best.value) best = found;
  }
  model = with(model, {parameter}, Eigen::VectorXd::Constant(1, best.at));
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
