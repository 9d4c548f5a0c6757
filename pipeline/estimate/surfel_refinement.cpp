// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surfel_refinement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/data/each_parameter.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/identifiability.hpp"
#include "pipeline/estimate/requested_terms.hpp"
#include "pipeline/estimate/standard_error_check.hpp"
#include "pipeline/estimate/surfel_refiner.hpp"

namespace crisp::estimate {
namespace {

/// One laser that has not come round to see surfaces from its other side, too, has only their flatness to go
/// by, and takes what is not flat for an error of its own.
std::optional<std::string> caveat_of_half_a_turn(const SensorModel& model, const Sample& sample) {
  const double way = turned(sample);
  if (model.lasers() > 1 || way > 0.98 * std::numbers::pi) return std::nullopt;
  return fmt::format(
      "the plate turned by {:.0f} degrees only: one laser then sees no surface twice, and only the flatness of surfaces determines its pose",
      way * 180 / std::numbers::pi);
}

/// How many of the parameters are λ, τ, α and η, which the surfaces' shape hangs on.
std::size_t of_base(const std::vector<std::size_t>& parameters, const SensorModel& model) {
  return static_cast<std::size_t>(
      std::ranges::count_if(parameters, [&](std::size_t p) { return !declared(model, p); }));
}

/// Where most parameters are held, the few that are free rest on what is assumed of the others. A steady
/// plate leaves fewer than half unobservable: each η and, but for the first, each λ.
std::optional<std::string> caveat_of_few(std::size_t free, std::size_t all, const Sample& sample) {
  if (2 * free >= all) return std::nullopt;
  return fmt::format(
      "these data determine {} of {} parameters only; the plate turned by {:.0f} degrees in all. Record several turns of the plate at changing rates, in a room with walls",
      free, all, turned(sample) * 180 / std::numbers::pi);
}

/// The model with held parameters at the rig's values, if the rig gives their standard deviations.
SensorModel with_nominal(const SensorModel& model, const std::vector<Unobservable>& held,
                         const ParameterPrior& prior) {
  SensorModel result = model;
  for (const Unobservable& each : held) {
    if (!prior.nominal.contains(each.parameter)) continue;
    const std::size_t parameter = model.index(each.parameter);
    result = with_one(result, parameter, centres_of(prior, model, {parameter})[0]);
  }
  return result;
}

/// The parameters that are held by request.
std::vector<std::size_t> fixed_parameters(const SensorModel& model, const Sample& sample,
                                          const RefinementSettings& settings) {
  if (settings.fixed.empty()) return {};
  std::vector<std::size_t> all = free_parameters(model, sample.beams, {}).free;
  const auto estimated = free_parameters(model, sample.beams, settings.fixed).free;
  std::erase_if(
      all, [&](std::size_t parameter) { return std::ranges::find(estimated, parameter) != estimated.end(); });
  return all;
}

/// Whether the parameter's prior is about another value than the start.
bool has_own_prior(const ParameterPrior& prior, const SensorModel& start, std::size_t parameter) {
  return prior.nominal.contains(start.names()[parameter]) || is_amplitude(start, parameter);
}

/// How the start, which counts as an observation, acts on the outcome.
enum class Pull {
  kNone,
  kDraws,  ///< it draws a parameter from where the data have it, by a good part of its standard error
  kIsFar   ///< a parameter moved farther than the start was trusted to
};

/// The start draws a parameter by (x − x₀) · s²/p² for a standard deviation p of the start.
Pull pull_of_start(const SurfelRefiner& refiner, const ParameterPrior& prior) {
  constexpr double kMuch = 0.2;
  const SensorModel& start = refiner.start();
  const Eigen::VectorXd trusted = ranges_of(prior, start, refiner.free());
  const Eigen::VectorXd moved =
      (picked(refiner.model(), refiner.free()) - picked(start, refiner.free())).cwiseAbs();
  Pull pull = Pull::kNone;
  for (Eigen::Index k = 0; k < moved.size(); ++k) {
    const std::size_t parameter = refiner.free()[static_cast<std::size_t>(k)];
    const std::string& name = start.names()[parameter];
    if (has_own_prior(prior, start, parameter)) continue;
    if (moved[k] > 2 * trusted[k]) return Pull::kIsFar;
    // Where the covered lags may end.
    if (name.ends_with(".eta") && moved[k] > 0.99 * trusted[k]) return Pull::kIsFar;
    const double error = std::sqrt(refiner.covariance()(k, k));
    if (moved[k] * error > kMuch * trusted[k] * trusted[k]) pull = Pull::kDraws;
  }
  return pull;
}

/// A refinement from one start, and what it was found with.
struct Attempt {
  std::unique_ptr<SurfelRefiner> refiner;
  Refinement refinement;
  Pull pull = Pull::kNone;
};

constexpr int kStarts = 4;  // at most, from each of which the data may draw the parameters further

Attempt refine_once(const SensorModel& start, const Sample& sample, const RefinementSettings& settings,
                    const RoundReporter& report, const SurfaceMap* known) {
  const LagRange lag = refined_lags(start, settings.prior);
  Sample inside = covered(sample, lag.earliest, lag.latest);
  const auto caveat = caveat_of_half_a_turn(start, inside);
  FreeParameters possible =
      free_parameters(start, inside.beams, settings.fixed, settings.terms, settings.forms);
  const std::size_t all = of_base(possible.free, start);
  FreeParameters parameters = identifiable_parameters(std::move(possible), start, inside, ParameterPrior{});
  auto owner = std::make_unique<SurfelRefiner>(with_nominal(start, parameters.unobservable, settings.prior),
                                               std::move(inside), parameters.free, settings, known);
  SurfelRefiner& refiner = *owner;
  int round = 0;
  int starts = 1;
  bool converged = false;
  while (!converged && round < settings.max_rounds && !refiner.free().empty()) {
    if (report && !report(round)) break;
    converged = refiner.step();
    ++round;
    for (auto& lost : refiner.hold_unobservable()) {
      parameters.unobservable.push_back(std::move(lost));
      converged = false;  // the others take one more step without it
    }
    // The surfaces are those of the model, and it need not begin anew.
    if (converged && starts < kStarts && pull_of_start(refiner, settings.prior) == Pull::kDraws) {
      refiner.take_as_start();
      ++starts;
      converged = false;
    }
  }
  if (refiner.free().empty()) {
    throw Error("these data determine none of the parameters",
                "record several turns of the plate in a room with walls, and check the option fixed");
  }
  const Pull pull = pull_of_start(refiner, settings.prior);
  if (settings.detail >= Detail::kStandardErrors) refiner.widen_by_shared_errors();
  refiner.consider_held(parameters.unobservable);
  const auto caveat_of_fixed = refiner.consider_fixed(fixed_parameters(start, sample, settings));
  const auto caveat_of_most = caveat_of_few(of_base(refiner.free(), start), all, sample);
  Refinement result = refiner.result();
  if (round > 0) check_errors(result.outcome, sample.beams, settings.surfels.floor, settings.prior);
  result.outcome.unobservable = std::move(parameters.unobservable);
  for (const auto& each : {caveat, caveat_of_most, caveat_of_fixed}) {
    if (each) result.outcome.caveats.push_back(*each);
  }
  result.determines_little = caveat_of_most.has_value();
  result.rounds = round;
  result.restarts = starts - 1;
  result.converged = converged;
  if (!converged && round == settings.max_rounds) {
    result.outcome.caveats.push_back(fmt::format(
        "the refinement did not converge in {} rounds: its last step was {:.2g} standard errors. Check for objects that moved in the scene, or record for longer",
        round, refiner.last_step()));
  }
  return {.refiner = std::move(owner), .refinement = std::move(result), .pull = pull};
}

/// The free parameters that a refinement moved by more than twice what its start was trusted to, in words.
std::vector<std::string> far_moves(const SensorModel& start, const Outcome& found,
                                   const ParameterPrior& prior) {
  constexpr double kFar = 2;
  std::map<std::string, data::ShownUnit> units;
  const Calibration calibration = found.model.calibration();
  data::for_each_parameter(calibration, [&](const std::string& name, const Parameter& parameter) {
    units[name] = data::shown_unit(parameter.unit);
  });
  const Eigen::VectorXd trusted = kFar * ranges_of(prior, start, found.free);
  const Eigen::VectorXd from = picked(start, found.free);
  const Eigen::VectorXd to = picked(found.model, found.free);
  std::vector<std::string> moves;
  for (Eigen::Index k = 0; k < from.size(); ++k) {
    const std::size_t parameter = found.free[static_cast<std::size_t>(k)];
    if (std::abs(to[k] - from[k]) <= trusted[k] || has_own_prior(prior, start, parameter)) continue;
    const std::string& name = start.names()[parameter];
    const data::ShownUnit& unit = units.at(name);
    moves.push_back(fmt::format("{} moved from {:.4g} to {:.4g} {}, by more than {:.3g} {}", name,
                                from[k] * unit.factor, to[k] * unit.factor, unit.name,
                                trusted[k] * unit.factor, unit.name));
  }
  return moves;
}

}  // namespace

Refinement refine_by_surfels(const SensorModel& start, const Sample& sample,
                             const RefinementSettings& settings, const RoundReporter& report,
                             std::shared_ptr<const SurfaceMap> known) {
  const auto was_stopped = [&](const Refinement& refinement) {
    return !refinement.converged && refinement.rounds < settings.max_rounds;
  };
  Attempt last = refine_once(start, sample, settings, report, known.get());
  const auto compared = [&] {
    if (settings.detail == Detail::kViews) last.refiner->compare_views(last.refinement);
    return std::move(last.refinement);
  };
  SensorModel from = start;
  // The start counts as an observation: a start that was far off would draw the result towards itself.
  for (int restart = 1; restart < kStarts; ++restart) {
    const Refinement& result = last.refinement;
    // A model that is only tested, and takes steps without end, is none to begin anew with.
    const bool is_settled =
        (result.converged || settings.detail == Detail::kModel) && last.pull == Pull::kNone;
    if (was_stopped(result) || is_settled) return compared();
    from = result.outcome.model;
    if (result.surfaces) known = result.surfaces;
    Attempt next = refine_once(from, sample, settings, report, known.get());
    if (was_stopped(next.refinement)) return compared();
    next.refinement.restarts += 1 + result.restarts;
    last = std::move(next);
  }
  Refinement result = compared();
  if (const auto moves = far_moves(from, result.outcome, settings.prior); !moves.empty()) {
    result.outcome.caveats.push_back(fmt::format(
        "the refinement did not converge: in the last of {} restarts {}. Check the rig's mount and nominal values, or start from a better calibration (calibrate.load)",
        kStarts - 1, fmt::join(moves, "; ")));
  }
  return result;
}

}  // namespace crisp::estimate
