// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/in_plane_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/identifiability.hpp"
#include "plugins/calibrate/cloud_objective.hpp"
#include "plugins/calibrate/grid_search.hpp"
#include "plugins/calibrate/wall_straightness.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Sample;
using estimate::slot;

/// The four steps, on a model that they move.
class InPlaneCalibration {
 public:
  InPlaneCalibration(SensorModel& model, const std::vector<std::size_t>& free, const Sample& sample,
                     Measure& measure, const InPlaneSettings& settings)
      : model_(model),
        free_(free),
        front_(estimate::in_plane(sample, settings.half_width, estimate::Half::kFront)),
        back_(estimate::in_plane(sample, settings.half_width, estimate::Half::kBack)),
        both_(estimate::in_plane(sample, settings.half_width, estimate::Half::kBoth)),
        measure_(measure),
        settings_(settings),
        bunches_(turns_both_ways(both_)) {}

  /// By the laser's own beams, if they show it: at constant speed they do not, and its start is kept until
  /// all lasers are compared.
  void find_eta(std::size_t laser) {
    const Sample front = estimate::of_laser(front_, laser);
    const Sample own = front.beams.size() < kFewBeams ? estimate::of_laser(back_, laser) : front;
    const auto free = those_free({slot(model_, laser, estimate::kEta)});
    if (own.beams.size() < kFewBeams || free.empty()) return;
    if (estimate::identifiable_parameters({.free = free, .unobservable = {}}, model_, own, settings_.range)
            .free.empty())
      return;
    const double centre = estimate::centres_of(settings_.range, model_, free)[0];
    const double reach = estimate::range_of(settings_.range, model_.names()[free[0]]);
    constexpr int kSteps = 25;  // to either side
    const auto grid = grid_around(centre, reach * kSteps / (kSteps + 1), kSteps);
    keep(multistart_search(model_, free[0], grid, false, own, measure_, settings_.range, narrowing()));
    if (bunches_) settle_eta(free[0], own);
  }

  void find_tau_alpha(std::size_t laser) {
    const Sample own = estimate::of_laser(both_, laser);
    const auto free =
        those_free({slot(model_, laser, estimate::kTau), slot(model_, laser, estimate::kAlpha)});
    if (!sees_both_sides(laser) || free.empty()) return;
    for (const double sigma : annealing(settings_.sigma_from, settings_.sigma_to)) {
      minimize_rqe(model_, estimate::thin_for(sigma, own), free, measure_, sigma, settings_.range,
                   sigma > settings_.sigma_to ? rough(settings_.minimizer) : settings_.minimizer);
    }
  }

  /// Each against the first laser whose λ is not free.
  void find_lambdas() {
    std::size_t reference = 0;
    while (reference < model_.lasers() &&
           (estimate::is_free(free_, slot(model_, reference, estimate::kLambda)) || has_few(reference)))
      ++reference;
    if (reference == model_.lasers()) return;
    for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
      const auto free = those_free({slot(model_, laser, estimate::kLambda)});
      if (free.empty() || has_few(laser)) continue;
      const Sample pair = estimate::select(both_, [&](std::size_t i) {
        return both_.beams.laser[i] == reference || both_.beams.laser[i] == laser;
      });
      find_lambda(free[0], pair);
    }
  }

  void find_geometry() {
    std::vector<std::size_t> geometry;
    for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
      std::vector<std::size_t> own = {slot(model_, laser, estimate::kLambda)};
      if (sees_both_sides(laser)) {
        own.insert(own.end(), {slot(model_, laser, estimate::kTau), slot(model_, laser, estimate::kAlpha)});
      }
      const auto free = those_free(own);
      if (!has_few(laser)) geometry.insert(geometry.end(), free.begin(), free.end());
    }
    if (geometry.empty()) return;
    minimize_rqe(model_, both_, geometry, measure_, settings_.sigma_to, settings_.range, settings_.minimizer);
  }

  const std::vector<CompetingMinimum>& competitors() const { return competitors_; }

 private:
  bool has_few(std::size_t laser) const {
    return std::cmp_less(std::ranges::count(both_.beams.laser, laser), kFewBeams);
  }

  /// Where a laser has one of the two beams only, RQE decreases as the room shrinks.
  bool sees_both_sides(std::size_t laser) const {
    return std::ranges::all_of(std::array{&front_, &back_}, [&](const Sample* half) {
      return !std::cmp_less(std::ranges::count(half->beams.laser, laser), kFewBeams);
    });
  }

  void keep(const std::optional<CompetingMinimum>& competitor) {
    if (competitor) competitors_.push_back(*competitor);
  }

  /// Half a scan to either side, which is as far as the next lag at which spots fall together.
  void settle_eta(std::size_t eta, const Sample& own) {
    constexpr int kSteps = 16;  // to either side
    const double centre = model_.values()[static_cast<Eigen::Index>(eta)];
    const double reach = between_scans(own) / 2;
    std::erase_if(competitors_, [&](const CompetingMinimum& competitor) {
      return competitor.parameter == eta && std::abs(competitor.at - centre) < reach;
    });
    keep(minimize_wall_residual(model_, eta, grid_around(centre, reach, kSteps), false, own,
                                settings_.sigma_to));
  }

  /// Where the rig gives no standard deviation, anywhere on the circle. Among equally low local minima the
  /// one near the start is chosen.
  void find_lambda(std::size_t lambda, const Sample& pair) {
    constexpr int kSteps = 120;  // 3°: the local minimum at σ = 0.5 m is wider in any room
    constexpr int kFine = 180;
    constexpr double kNear = 20 * data::kDegree;
    const int steps = bunches_ ? kFine : kSteps;
    const std::string& name = model_.names()[lambda];
    const auto within = [&](double centre, double reach) {
      return grid_of_step(centre, reach, 2 * std::numbers::pi / steps);
    };
    if (settings_.range.nominal.contains(name)) {
      const double centre = estimate::centres_of(settings_.range, model_, {lambda})[0];
      const auto grid = within(centre, estimate::range_of(settings_.range, name));
      return keep(to_best_lambda(model_, lambda, grid, false, pair));
    }
    const SensorModel start = model_;
    const double from = start.values()[static_cast<Eigen::Index>(lambda)];
    const auto is_near = [&](double value) { return between(value, from, true) < kNear; };
    const auto competitor = to_best_lambda(model_, lambda, grid_on_circle(steps), true, pair);
    if (is_near(model_.values()[static_cast<Eigen::Index>(lambda)])) {
      if (competitor && is_near(competitor->at)) keep(competitor);
      return;
    }
    SensorModel near = start;
    to_best_lambda(near, lambda, within(from, kNear), false, pair);
    if (height_above(near, model_, pair) < kClearlyDeeper) {
      model_ = near;
    } else {
      keep(competitor);
    }
  }

  std::optional<CompetingMinimum> to_best_lambda(SensorModel& model, std::size_t lambda,
                                                 const std::vector<double>& grid, bool circular,
                                                 const Sample& pair) const {
    return bunches_ ? minimize_wall_residual(model, lambda, grid, circular, pair, settings_.sigma_to)
                    : multistart_search(model, lambda, grid, circular, pair, measure_, settings_.range,
                                        narrowing());
  }

  /// [nat] By how much less crisp the cloud is with one model than with another.
  double height_above(const SensorModel& model, const SensorModel& best, const Sample& pair) const {
    if (bunches_) {
      const double noise = settings_.sigma_to;
      return std::log(wall_straightness(model, pair, noise) / wall_straightness(best, pair, noise)) / 2;
    }
    const Sample thin = estimate::thin_for(settings_.sigma_to, pair);
    return model_quality(model, thin, measure_, settings_.sigma_to) -
           model_quality(best, thin, measure_, settings_.sigma_to);
  }

  Narrowing narrowing() const { return {.from = settings_.sigma_from, .to = settings_.sigma_to}; }

  std::vector<std::size_t> those_free(const std::vector<std::size_t>& slots) const {
    std::vector<std::size_t> result;
    std::copy_if(slots.begin(), slots.end(), std::back_inserter(result),
                 [&](std::size_t s) { return estimate::is_free(free_, s); });
    return result;
  }

  SensorModel& model_;
  std::vector<CompetingMinimum> competitors_;
  const std::vector<std::size_t>& free_;
  Sample front_;
  Sample back_;
  Sample both_;
  Measure& measure_;
  const InPlaneSettings& settings_;
  bool bunches_;  ///< spots of the plate's two senses of rotation may fall together
};

/// The directions in which beams went that lie in the plate's plane, in turns of the plate, ascending.
std::vector<double> directions(const Sample& own) {
  std::vector<double> result;
  for (std::size_t i = 0; i < own.beams.size(); ++i) {
    const double half = own.beams.mirror_angle[i] < 0 ? 0 : 0.5;
    const double turns = own.plate->at(own.beams.time[i])->angle / (2 * std::numbers::pi) + half;
    result.push_back(turns - std::floor(turns));
  }
  std::ranges::sort(result);
  return result;
}

/// [rad] Between neighbouring directions of a laser's beams.
double spacing(const Sample& own) {
  constexpr double kSame = 1 / 360.0;   // turns: nearer ones are one
  constexpr double kUnseen = 1 / 12.0;  // turns: where the plate did not turn to at all
  const auto tested = directions(own);
  double seen = 0;
  double distinct = 0;
  for (std::size_t i = 0; i + 1 < tested.size(); ++i) {
    const double gap = tested[i + 1] - tested[i];
    if (gap > kUnseen) continue;
    seen += gap;
    distinct += std::min(gap, kSame);
  }
  return seen == 0 ? 0 : 2 * std::numbers::pi * kSame * seen / distinct;
}

}  // namespace

bool sees_single_spots(const Sample& sample, const InPlaneSettings& settings) {
  constexpr double kFar = 5 * data::kDegree;  // half a metre on a wall in 6 m
  const Sample both = estimate::in_plane(sample, settings.half_width, estimate::Half::kBoth);
  const std::set<std::uint16_t> lasers(both.beams.laser.begin(), both.beams.laser.end());
  return std::ranges::any_of(lasers,
                             [&](auto laser) { return spacing(estimate::of_laser(both, laser)) > kFar; });
}

std::vector<CompetingMinimum> calibrate_in_plane(SensorModel& model, const std::vector<std::size_t>& free,
                                                 const Sample& sample, Measure& measure,
                                                 const InPlaneSettings& settings) {
  InPlaneCalibration calibration(model, free, sample, measure, settings);
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) calibration.find_eta(laser);
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) calibration.find_tau_alpha(laser);
  calibration.find_lambdas();
  calibration.find_geometry();
  return calibration.competitors();
}

}  // namespace crisp::calibrate
