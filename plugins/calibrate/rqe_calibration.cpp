// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rqe_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/identifiability.hpp"
#include "pipeline/estimate/observability.hpp"
#include "pipeline/estimate/scene_repeat.hpp"
#include "pipeline/statistics/dense_solvers.hpp"
#include "plugins/calibrate/grid_search.hpp"
#include "plugins/calibrate/report.hpp"
#include "plugins/calibrate/rqe_minimizer.hpp"
#include "plugins/calibrate/sandwich_covariance.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Sample;

constexpr const char* kSingleSpots =
    "the beams have few directions only, since the rates of the plate and the mirrors are commensurate: walls appear as separate spots, whose RQE does not determine a calibration. Record at another rate, or with a changing one";

void refuse_a_standing_plate(const PlateTrajectory& plate) {
  constexpr double kMin = 1 * data::kDegree;
  const auto [low, high] = std::ranges::minmax(plate.angles());
  if (high - low >= kMin) return;
  throw Error("the plate is stationary in these data: no surface is seen twice", "record while it turns");
}

/// @param inside  those of the beams that are covered at all the lags of the search
void refuse_a_short_recording(const Sample& all, const Sample& inside, const estimate::LagRange& lag,
                              double half_width) {
  if (estimate::covered(all, 0, 0).beams.size() == 0) {
    throw Error("the encoder readings cover none of the beams",
                "check by crisp info that the plate's sentences are in the capture");
  }
  const Sample front = in_plane(inside, half_width, estimate::Half::kFront);
  std::map<std::uint16_t, std::size_t> scans;
  for (const auto laser : front.beams.laser) ++scans[laser];
  const auto enough = [](const auto& laser) { return laser.second >= kFewBeams; };
  const bool is_there = !scans.empty() || inside.beams.size() == 0;  // some scanners do not
  if (!is_there || std::ranges::any_of(scans, enough)) return;
  throw Error(
      fmt::format(
          "the recording is too short: no laser has {} scans that encoder readings cover at lags of {:.0f} to {:.0f} ms",
          kFewBeams, lag.earliest * 1e3, lag.latest * 1e3),
      "record several turns of the plate");
}

/// One calibration from start to end; each step moves the model.
class RqeCalibration {
 public:
  RqeCalibration(const SensorModel& start, const Sample& sample, Measure& measure,
                 const RqeCalibrationSettings& settings, const Reporter& report)
      : settings_(settings),
        measure_(measure),
        report_(report),
        model_(start),
        sample_(with_margin(start, sample, settings_.in_plane)),
        parameters_(
            estimate::identifiable_parameters(estimate::free_parameters(start, sample.beams, settings.fixed),
                                              start, sample_, settings.in_plane.range)) {
    keep_where_one_side_is_seen();
    if (parameters_.free.empty()) {
      throw Error("these data leave no parameter to calibrate",
                  "record with more than one laser or with a turning plate, and check the option fixed");
    }
  }

  estimate::Outcome run() {
    const SensorModel start = model_;
    Eigen::MatrixXd covariance;
    while (!parameters_.free.empty()) {
      const Sample used = minimize();
      if (!hold_lags_without_minimum()) {
        report(0.8, "standard errors");
        covariance = scatter(used);
        if (!hold_unobservable(covariance)) break;
      }
      model_ = start;  // so that the others are found with the held ones there
      covariance = {};
    }
    return {.model = model_,
            .free = parameters_.free,
            .covariance = std::move(covariance),
            .unobservable = parameters_.unobservable,
            .caveats = caveats(),
            .other_minima = other_minima(),
            .not_estimated = not_estimated_};
  }

 private:
  /// Minimizes over the free parameters; the beams that were used at last.
  Sample minimize() {
    in_plane();
    if (settings_.full_field) return full_field_from_each_minimum();
    return estimate::in_plane(sample_, settings_.in_plane.half_width, estimate::Half::kBoth);
  }

  /// Holds the parameters that are less well determined than by their ranges; whether there were any.
  bool hold_unobservable(const Eigen::MatrixXd& covariance) {
    auto known =
        estimate::observability(statistics::inverse(covariance), parameters_.free, model_.names(),
                                estimate::ranges_of(settings_.in_plane.range, model_, parameters_.free));
    parameters_.free = std::move(known.known);
    parameters_.unobservable.insert(parameters_.unobservable.end(), known.unobservable.begin(),
                                    known.unobservable.end());
    return !known.unobservable.empty();
  }

  /// The beams that encoder readings cover at every η of the search; sets the range's ends.
  static Sample with_margin(const SensorModel& start, const Sample& sample, InPlaneSettings& settings) {
    estimate::ParameterPrior& range = settings.range;
    const estimate::LagRange lag = estimate::lag_range(start, range.eta);
    range.earliest_eta = lag.earliest;
    range.latest_eta = lag.latest;
    Sample inside = estimate::covered(sample, lag.earliest, lag.latest);
    refuse_a_short_recording(sample, inside, lag, settings.half_width);
    refuse_a_standing_plate(*inside.plate);
    return inside;
  }

  /// Holds lags that reached the end of their range: RQE has no minimum near the start then, as where the
  /// plate hardly changes its rate; whether there were any.
  ///
  /// @throws Error  if counts that are wrong are the reason
  bool hold_lags_without_minimum() {
    const auto has_no_minimum = [&](std::size_t parameter) {
      return estimate::is_at_the_end(settings_.in_plane.range, model_.names()[parameter],
                                     model_.values()[static_cast<Eigen::Index>(parameter)]);
    };
    const std::size_t before = not_estimated_.size();
    std::ranges::copy_if(parameters_.free, std::back_inserter(not_estimated_), has_no_minimum);
    if (not_estimated_.size() == before) return false;
    const auto period = estimate::scene_repeat(sample_);
    if (period && estimate::contradicts_counts(*period)) throw Error(estimate::counts_caveat(*period));
    std::erase_if(parameters_.free, has_no_minimum);
    return true;
  }

  /// Leaves τ and α as they are where a laser sees next to nothing on one side of the spin axis: there is no
  /// surface then that it sees twice, from either side, and an entropy falls as τ and α make the scene
  /// smaller.
  void keep_where_one_side_is_seen() {
    constexpr double kMinShare = 0.15;
    for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
      const Sample own = estimate::of_laser(sample_, laser);
      const auto left = static_cast<double>(
          std::ranges::count_if(own.beams.mirror_angle, [](float theta) { return theta < 0; }));
      const auto all = static_cast<double>(own.beams.size());
      if (std::min(left, all - left) >= kMinShare * all) continue;
      for (const estimate::BaseSlot which : {estimate::kTau, estimate::kAlpha}) {
        if (std::erase(parameters_.free, estimate::slot(model_, laser, which)) > 0) {
          not_estimated_.push_back(estimate::slot(model_, laser, which));
        }
      }
    }
  }

  void report(double done, std::string_view what) const {
    if (report_) report_(done, what);
  }

  void in_plane() {
    report(0, "beams in the plate's plane");
    competitors_ = calibrate_in_plane(model_, parameters_.free, sample_, measure_, settings_.in_plane);
  }

  Sample full_field() {
    const auto sigmas = annealing(settings_.sigma_from, settings_.sigma_to);
    Sample thin;
    for (std::size_t k = 0; k < sigmas.size(); ++k) {
      report(0.25 + 0.55 * static_cast<double>(k) / static_cast<double>(sigmas.size()),
             fmt::format("sigma {:.2g} cm", sigmas[k] * 100));
      thin = estimate::thin_by_area(sample_, model_, estimate::beams_for(sigmas[k], settings_.points),
                                    settings_.seed);
      const MinimizerSettings& minimizer = settings_.in_plane.minimizer;
      minimize_rqe(model_, thin, parameters_.free, measure_, sigmas[k], settings_.in_plane.range,
                   k + 1 < sigmas.size() ? rough(minimizer) : minimizer);
    }
    return thin;
  }

  /// Minimizes over the full field from the optimum in the plate's plane and from each other minimum that was
  /// about as deep there, and leaves the model at the best: lines in one plane can fit by chance where the
  /// plate hardly changes its rate; all beams together hardly ever do.
  Sample full_field_from_each_minimum() {
    const SensorModel in_plane_optimum = model_;
    std::erase_if(competitors_,
                  [](const CompetingMinimum& competitor) { return competitor.height > kClearlyDeeper; });
    Sample used = full_field();
    for (CompetingMinimum& competitor : competitors_) {
      const SensorModel best = model_;
      model_ = estimate::with_one(in_plane_optimum, competitor.parameter, competitor.at);
      std::vector<std::size_t> others = parameters_.free;  // lags as they were found
      std::erase_if(others, [&](std::size_t parameter) {
        return parameter == competitor.parameter || model_.names()[parameter].ends_with(".eta");
      });
      report(0.25, fmt::format("competing minimum, of {}", model_.names()[competitor.parameter]));
      calibrate_in_plane(model_, others, sample_, measure_, settings_.in_plane);
      Sample own = full_field();
      const auto quality = rqe_of({best, model_}, sample_, {.sigma = settings_.sigma_to}, measure_);
      const auto place = static_cast<Eigen::Index>(competitor.parameter);
      competitor.height = std::abs(quality[1] - quality[0]);
      competitor.at = quality[1] < quality[0] ? best.values()[place] : model_.values()[place];
      if (quality[1] < quality[0]) {
        used = std::move(own);
      } else {
        model_ = best;
      }
    }
    std::erase_if(competitors_,
                  [&](const CompetingMinimum& competitor) { return is_same_minimum(competitor, used); });
    return used;
  }

  /// Whether all beams led from both minima to one: to where they place the cloud alike to within the kernel.
  bool is_same_minimum(const CompetingMinimum& competitor, const Sample& used) const {
    const double here = model_.values()[static_cast<Eigen::Index>(competitor.parameter)];
    const bool is_angle = !model_.names()[competitor.parameter].ends_with(".eta");
    const double step = search_basis(model_, used, {competitor.parameter}, settings_.in_plane.range,
                                     settings_.sigma_to)(0, 0);
    return between(competitor.at, here, is_angle) <= std::abs(step);
  }

  Eigen::MatrixXd scatter(const Sample& used) {
    const double sigma = settings_.full_field ? settings_.sigma_to : settings_.in_plane.sigma_to;
    return sandwich_covariance(model_, used, parameters_.free, measure_,
                               {.scale = sigma,
                                .noise = settings_.noise,
                                .probes = settings_.probes,
                                .seed = settings_.seed,
                                .range = settings_.in_plane.range});
  }

  std::vector<std::string> caveats() const {
    std::vector<std::string> found;
    if (sees_single_spots(sample_, settings_.in_plane)) found.emplace_back(kSingleSpots);
    for (const CompetingMinimum& competitor : competitors_) {
      if (is_indistinct(competitor)) found.push_back(in_words(competitor));
    }
    return found;
  }

  std::vector<std::string> other_minima() const {
    std::vector<std::string> found;
    for (const CompetingMinimum& competitor : competitors_) {
      if (!is_indistinct(competitor) && competitor.height <= kClearlyDeeper)
        found.push_back(in_words(competitor));
    }
    return found;
  }

  /// Whether all beams together do not separate two minima: no refinement of the one does, either.
  bool is_indistinct(const CompetingMinimum& competitor) const {
    constexpr double kIndistinct = 0.02;  // [nat]
    return settings_.full_field && competitor.height <= kIndistinct;
  }

  std::string in_words(const CompetingMinimum& competitor) const {
    const std::string& name = model_.names()[competitor.parameter];
    const data::ShownUnit unit = data::shown_unit(name.ends_with(".eta") ? "s" : "rad");
    const double here = model_.values()[static_cast<Eigen::Index>(competitor.parameter)];
    return fmt::format(
        "{} has a competing minimum at {:.4g} {}, next to {:.4g} {}, whose RQE{} differs by {:.3f} nat only: change the plate's rate more, record longer, or give {} with its sd in the rig",
        name, competitor.at * unit.factor, unit.name, here * unit.factor, unit.name,
        settings_.full_field ? "" : " of the beams in the plate's plane", competitor.height, name);
  }

  RqeCalibrationSettings settings_;
  Measure& measure_;
  const Reporter& report_;
  SensorModel model_;
  std::vector<CompetingMinimum> competitors_;
  Sample sample_;
  estimate::FreeParameters parameters_;
  std::vector<std::size_t> not_estimated_;
};

}  // namespace

estimate::Outcome calibrate_by_rqe(const SensorModel& start, const Sample& sample, Measure& measure,
                                   const RqeCalibrationSettings& settings, const Reporter& report) {
  return RqeCalibration(start, sample, measure, settings, report).run();
}

}  // namespace crisp::calibrate
