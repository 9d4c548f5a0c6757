// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/figures.hpp"

#include <algorithm>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/paper.hpp"
#include "pipeline/estimate/base_parameters.hpp"
#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/rqe_minimizer.hpp"

namespace crisp::study {
namespace {

using estimate::kEta;

/// The parts of the figures, all of one recording.
class Studio {
 public:
  Studio(const FigureSettings& settings, Measure& measure)
      : settings_(settings), measure_(measure), recording_(one_laser(settings)), truth_(recording_.truth) {
    const estimate::Sample all{.beams = recording_.beams, .plate = &recording_.plate};
    both_ = estimate::covered(all, settings.lag.first, settings.lag.last);
    front_ = estimate::in_plane(both_, calibrate::InPlaneSettings{}.half_width, estimate::Half::kFront);
  }

  CostSurface surface() {
    CostSurface surface;
    for (std::size_t i = 0; i < settings_.tau.steps; ++i) {
      const SensorModel row = estimate::with_one(truth_, estimate::kTau, settings_.tau.at(i));
      const auto costs = curve(row, estimate::kAlpha, settings_.alpha, both_, settings_.sigma);
      surface.cost.insert(surface.cost.end(), costs.begin(), costs.end());
    }
    return surface;
  }

  CostCurves curves(std::size_t parameter, const Axis& axis) {
    CostCurves curves;
    for (const double sigma : settings_.widths) {
      curves.cost.push_back(curve(truth_, parameter, axis, both_, sigma));
    }
    return curves;
  }

  std::vector<Optimum> optima() {
    std::vector<Optimum> optima;
    for (const double sigma : settings_.widths) {
      SensorModel model = truth_;
      calibrate::minimize_rqe(model, both_, {estimate::kTau, estimate::kAlpha}, measure_, sigma, {.tau = 0.4},
                              {});
      optima.push_back(
          {.sigma = sigma, .tau = model.values()[estimate::kTau], .alpha = model.values()[estimate::kAlpha]});
    }
    return optima;
  }

  CostCurves over_lag() {
    CostCurves curves;
    for (const double sigma : settings_.lag_widths) {
      curves.cost.push_back(curve(truth_, kEta, settings_.lag, front_, sigma));
    }
    return curves;
  }

  BeamCloud cloud(const SensorModel& model) const {
    return {.eta = model.values()[kEta],
            .points = model.place(front_.beams, *front_.plate).points.topRows<2>()};
  }
  BeamCloud before() const { return cloud(estimate::with_one(truth_, kEta, 0)); }
  BeamCloud after() {
    constexpr double kSigma = 0.04;  // [m]
    const auto costs = curve(truth_, kEta, settings_.lag, front_, kSigma);
    const auto least = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
    SensorModel model = estimate::with_one(truth_, kEta, settings_.lag.at(least));
    calibrate::minimize_rqe(model, front_, {kEta}, measure_, kSigma, {.eta = 0.002}, {});
    return cloud(model);
  }

 private:
  static simulate::SimulatedMeasurements one_laser(const FigureSettings& settings) {
    simulate::ScannerSettings scanner = simulate::paper_scanner(settings.seed);
    scanner.rig.lasers.resize(1);
    scanner.truth = nominal_calibration(scanner.rig);
    scanner.truth.lasers[0].eta.value = settings.eta;
    return simulate::simulate_measurements(scanner, simulate::paper_room());
  }

  std::vector<double> curve(const SensorModel& model, std::size_t parameter, const Axis& axis,
                            const estimate::Sample& sample, double sigma) {
    std::vector<double> costs;
    for (std::size_t i = 0; i < axis.steps; ++i) {
      costs.push_back(calibrate::model_quality(estimate::with_one(model, parameter, axis.at(i)), sample,
                                               measure_, sigma));
    }
    return costs;
  }

  const FigureSettings& settings_;
  Measure& measure_;
  simulate::SimulatedMeasurements recording_;
  SensorModel truth_;
  estimate::Sample both_;
  estimate::Sample front_;
};

}  // namespace

Figures make_figures(const FigureSettings& settings, Measure& measure,
                     const std::function<bool()>& interrupted) {
  Studio studio(settings, measure);
  Figures figures;
  const std::vector<std::function<void()>> parts = {
      [&] { figures.before = studio.before(); },
      [&] { figures.after = studio.after(); },
      [&] { figures.surface = studio.surface(); },
      [&] { figures.over_tau = studio.curves(estimate::kTau, settings.tau); },
      [&] { figures.over_alpha = studio.curves(estimate::kAlpha, settings.alpha); },
      [&] { figures.optima = studio.optima(); },
      [&] { figures.over_lag = studio.over_lag(); }};
  for (const auto& part : parts) {
    if (interrupted && interrupted()) break;
    part();
  }
  return figures;
}

}  // namespace crisp::study
