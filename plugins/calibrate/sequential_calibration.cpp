// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/sequential_calibration.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/base_parameters.hpp"
#include "plugins/calibrate/grid_search.hpp"

namespace crisp::calibrate {
namespace {

using Views = std::vector<estimate::ViewConsistency>;

/// The views of the walls alone, which show λ.
Views of_walls(const Views& views) {
  Views walls;
  std::ranges::copy_if(views, std::back_inserter(walls), [](const estimate::ViewConsistency& pair) {
    return pair.orientation == estimate::Orientation::upright;
  });
  return walls;
}

/// Whether walls of two lasers are known to agree, seen from either.
bool agree(const Views& walls, const std::string& one, const std::string& other) {
  bool is_known = false;
  for (const auto& pair : walls) {
    const bool is_theirs =
        (pair.view == one && pair.other == other) || (pair.view == other && pair.other == one);
    if (is_theirs && pair.share <= estimate::kConsistentShare) return false;
    is_known = is_known || is_theirs;
  }
  return is_known;
}

/// Moves the laser to the λ at which the RQE of the sample is least.
void search_lambda(SensorModel& model, std::size_t laser, const estimate::Sample& sample,
                   const estimate::ParameterPrior& range, Measure& measure) {
  constexpr std::size_t kBeams = 60'000;
  constexpr std::uint64_t kSeed = 1;
  constexpr double kStep = 2 * data::kDegree;  // the local minimum at the widest kernel is wider in any room
  constexpr Narrowing kKernel{.from = 0.5, .to = 0.05};
  const std::size_t lambda = estimate::slot(model, laser, estimate::kLambda);
  const double centre = estimate::centres_of(range, model, {lambda})[0];
  const double reach = estimate::range_of(range, model.names()[lambda]);
  const auto grid = grid_of_step(centre, reach, kStep);
  const estimate::Sample thin =
      estimate::thin_by_area(estimate::placeable(model, sample), model, kBeams, kSeed);
  multistart_search(model, lambda, grid, false, thin, measure, range, kKernel);
}

}  // namespace

std::vector<bool> agreeing_lasers(const estimate::Refinement& refined) {
  const std::vector<LaserCalibration> lasers = refined.outcome.model.calibration().lasers;
  const Views walls = of_walls(refined.views);
  std::vector<bool> agreeing(lasers.size(), false);
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    agreeing[i] = i == 0 || std::ranges::count(walls, lasers[i].name, &estimate::ViewConsistency::view) == 0;
  }
  const auto joins = [&](std::size_t one) {
    for (std::size_t other = 0; other < lasers.size(); ++other) {
      if (agreeing[other] && agree(walls, lasers[one].name, lasers[other].name)) return true;
    }
    return false;
  };
  for (std::size_t round = 1; round < lasers.size(); ++round) {
    for (std::size_t one = 0; one < lasers.size(); ++one) agreeing[one] = agreeing[one] || joins(one);
  }
  return agreeing;
}

SensorModel calibrated_one_by_one(const SensorModel& start, std::vector<bool> aligned,
                                  const estimate::Sample& sample, const estimate::ParameterPrior& range,
                                  const estimate::RefinementSettings& settings, Measure& measure,
                                  const estimate::RoundReporter& report) {
  constexpr std::size_t kBeams = 100'000;
  constexpr std::uint64_t kSeed = 2;
  estimate::RefinementSettings fast = settings;
  fast.detail = estimate::Detail::kModel;
  const auto refined = [&](const SensorModel& model, const estimate::Sample& own) {
    return estimate::refine_by_surfels(model, estimate::thin_evenly(own, kBeams, kSeed), fast, report)
        .outcome.model;
  };
  const auto refined_alone = [&](const SensorModel& model, std::size_t laser) {
    try {
      return refined(model, estimate::of_laser(sample, laser));
    } catch (const Error&) {
      return model;  // it sees no surface twice
    }
  };
  SensorModel model = start;
  if (std::ranges::count(aligned, true) == 1)
    model =
        refined_alone(model, static_cast<std::size_t>(std::ranges::find(aligned, true) - aligned.begin()));
  for (std::size_t laser = 0; laser < aligned.size(); ++laser) {
    if (aligned[laser]) continue;
    if (report && !report(0)) break;
    aligned[laser] = true;
    const estimate::Sample own =
        estimate::select(sample, [&](std::size_t i) { return aligned[sample.beams.laser[i]]; });
    model = refined_alone(model, laser);
    search_lambda(model, laser, own, range, measure);
    model = refined(model, own);
  }
  return model;
}

}  // namespace crisp::calibrate
