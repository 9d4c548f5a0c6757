// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surfel_refinement.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "pipeline/data/each_parameter.hpp"
#include "pipeline/data/error.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "pipeline/estimate/base_slots.hpp"
#include "pipeline/estimate/can_be_told.hpp"
#include "pipeline/estimate/considered.hpp"
#include "pipeline/estimate/encoder_quantization.hpp"
#include "pipeline/estimate/flat_surfaces.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/incidence.hpp"
#include "pipeline/estimate/observability.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/relative_noise.hpp"
#include "pipeline/estimate/shared_errors.hpp"
#include "pipeline/estimate/standard_errors.hpp"
#include "pipeline/estimate/steady.hpp"
#include "pipeline/estimate/surfel_rows.hpp"
#include "pipeline/estimate/view_consistency.hpp"
#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp {
namespace {

/// Equations at a model, with the start as one more observation.
class Refiner {
 public:
  Refiner(const SensorModel& start, Sample sample, std::vector<std::size_t> free,
          std::unique_ptr<FlatSurfaces> surfaces, const RefinementSettings& settings)
      : start_(start),
        model_(start),
        sample_(std::move(sample)),
        free_(std::move(free)),
        surfaces_(std::move(surfaces)),
        settings_(settings) {}

  /// @return  whether nothing more is to be expected of the next one
  bool step() {
    const PlacedBeams placed(model_, sample_);
    all_ = surfaces_->update(placed.view(noise_), last_step_);
    found_ = steady_ones(all_, placed.view(noise_));
    if (found_.surfels.empty()) {
      throw Error(
          "no flat surface is seen by these data",
          "leave calibrate.refine out where nothing is flat, or look closer with a smaller `smallest`");
    }
    // For terms that depend on it.
    sample_.beams.cos_incidence = incidences(found_, placed.view(noise_));
    equations_ = normal_equations(found_, placed.view(noise_), free_.size(),
                                  surfel_rows(model_, sample_, free_), settings_.surfels);
    information_ = equations_.matrix / equations_.covariance_factor();
    const Eigen::VectorXd prior = ranges_of(settings_.prior, model_, free_).cwiseAbs2().cwiseInverse();
    const Eigen::VectorXd from_start = picked(model_, free_) - centres_of(settings_.prior, start_, free_);
    const Eigen::VectorXd pull =
        equations_.vector / equations_.covariance_factor() + prior.cwiseProduct(from_start);
    const auto n = information_.rows();
    const auto posterior = (information_ + Eigen::MatrixXd(prior.asDiagonal())).eval().ldlt();
    covariance_ = posterior.solve(Eigen::MatrixXd::Identity(n, n));
    covariance_ = covariance_.selfadjointView<Eigen::Lower>();  // to the last bit
    const Eigen::VectorXd before = picked(model_, free_);
    const Eigen::VectorXd after = keep_covered(within_bounds(model_, free_, before - posterior.solve(pull)));
    const Eigen::VectorXd change = after - before;
    model_ = with(model_, free_, after);
    last_step_ = (change.array() / covariance_.diagonal().array().sqrt()).abs().maxCoeff();
    const bool weighs_anew = tell_noise(placed.view(noise_));
    return surfaces_->is_settled() && last_step_ < settings_.tolerance && !weighs_anew;
  }

  /// Keeps at their start those that the data do not tell. Not as long as surfaces are looked for: few may
  /// have been found yet.
  std::vector<Unobservable> hold_unknown() {
    if (!surfaces_->is_settled()) return {};
    // What the rig knows is no more than one observation, and never has to be held.
    constexpr double kNeverHeld = 10;
    Eigen::MatrixXd information = information_;
    Eigen::VectorXd ranges = ranges_of(settings_.prior, model_, free_);
    for (std::size_t k = 0; k < free_.size(); ++k) {
      if (!settings_.prior.nominal.contains(model_.names()[free_[k]])) continue;
      const auto i = static_cast<Eigen::Index>(k);
      information(i, i) += 1 / (ranges[i] * ranges[i]);
      ranges[i] *= kNeverHeld;
    }
    auto told = observability(information, free_, model_.names(), ranges);
    if (told.unobservable.empty()) return {};
    const SensorModel found = model_;
    model_ = with(start_, told.known, picked(found, told.known));
    free_ = told.known;
    return told.unobservable;
  }

  /// Widens the standard errors to what pieces of the recording, directions of the mirrors, or places on the
  /// surfaces disagree by.
  void widen_by_shared_errors() {
    if (found_.surfels.empty()) return;
    const PlacedBeams placed(model_, sample_);
    const auto equations =
        normal_equations(found_, placed.view(noise_), free_.size(), surfel_rows(model_, sample_, free_),
                         settings_.surfels, shared_errors(sample_.beams, found_, placed.view(noise_)));
    covariance_ = widened(covariance_, widening(equations));
    if (settings_.angle_step > 0) covariance_ = widened(covariance_, widening_by_quantization(equations));
  }

  /// Adds to the covariance what held parameters may be off by, and no longer calls free what hangs on them.
  ///
  /// @param unobservable  those that are held; gets what hangs on them
  void consider_held(std::vector<Unobservable>& unobservable) {
    if (unobservable.empty() || found_.surfels.empty()) return;
    std::vector<std::size_t> all = free_;
    std::vector<std::string> names;
    Eigen::VectorXd prior(static_cast<Eigen::Index>(unobservable.size()));
    bool is_from_rig = true;
    for (const Unobservable& held : unobservable) {
      prior[static_cast<Eigen::Index>(all.size() - free_.size())] = prior_of_held(held.parameter);
      is_from_rig = is_from_rig && settings_.prior.nominal.contains(held.parameter);
      all.push_back(model_.index(held.parameter));
    }
    for (const std::size_t parameter : all) names.push_back(model_.names()[parameter]);
    const PlacedBeams placed(model_, sample_);
    const auto equations = normal_equations(found_, placed.view(noise_), all.size(),
                                            surfel_rows(model_, sample_, all), settings_.surfels);
    Considered considered = consider(covariance_, equations.matrix, names, prior);
    covariance_ = std::move(considered.covariance);
    if (is_from_rig) return;  // then the standard errors say how well everything is known
    for (Unobservable& lost : considered.dependent) {
      const std::size_t at =
          static_cast<std::size_t>(std::ranges::find(free_, model_.index(lost.parameter)) - free_.begin());
      remove(at);
      unobservable.push_back(std::move(lost));
    }
  }

  const SensorModel& model() const { return model_; }
  const std::vector<std::size_t>& free() const { return free_; }

  Refinement result() const {
    Refinement result{.outcome = {.model = model_,
                                  .free = free_,
                                  .covariance = covariance_,
                                  .unobservable = {},
                                  .doubts = {}},
                      .surfels = found_.surfels.size(),
                      .beams = equations_.beams,
                      .chi2 = equations_.chi2 / std::max(1.0, equations_.freedom)};
    if (found_.surfels.empty()) return result;
    const PlacedBeams placed(model_, sample_);
    result.scatter = neighbour_noise(found_, placed.view(noise_), sample_.beams, settings_.surfels);
    for (const ViewPartition& partition : view_partitions(sample_, lasers())) {
      const auto pairs = view_consistency(all_, placed.view(noise_), partition,
                                          {.range = settings_.surfels.noise, .angle = settings_.angle_error});
      if (const auto caveat = inconsistency(partition, pairs)) result.outcome.doubts.push_back(*caveat);
      result.views.insert(result.views.end(), pairs.begin(), pairs.end());
    }
    return result;
  }

 private:
  /// By how much standard errors grow as beams share the errors of the encoder's steps.
  ///
  /// @param without  the equations as if they did not
  Eigen::VectorXd widening_by_quantization(const NormalEquations& without) const {
    const PlacedBeams placed(model_, sample_);
    const auto noise = noise_with_quantization(found_, placed.view(noise_), sample_, settings_.angle_step,
                                               settings_.surfels.noise);
    const auto with = normal_equations(found_, placed.view(noise), free_.size(),
                                       surfel_rows(model_, sample_, free_), settings_.surfels);
    const Eigen::VectorXd prior = ranges_of(settings_.prior, model_, free_).cwiseAbs2().cwiseInverse();
    const auto variances = [&](const NormalEquations& equations) -> Eigen::VectorXd {
      const Eigen::MatrixXd information = equations.matrix / without.covariance_factor();
      return inverse(information + Eigen::MatrixXd(prior.asDiagonal())).diagonal();
    };
    return variances(with).cwiseQuotient(variances(without)).cwiseSqrt().cwiseMax(1);
  }

  /// Each η no farther than the plate's readings cover the beams.
  Eigen::VectorXd keep_covered(Eigen::VectorXd values) const {
    const LagRange lag = lag_range(start_, settings_.prior.eta);
    for (std::size_t k = 0; k < free_.size(); ++k) {
      if (!model_.names()[free_[k]].ends_with(".eta")) continue;
      double& eta = values[static_cast<Eigen::Index>(k)];
      eta = std::clamp(eta, lag.earliest, lag.latest);
    }
    return values;
  }

  double prior_of_held(const std::string& name) const {
    const auto known = settings_.prior.nominal.find(name);
    return known != settings_.prior.nominal.end() ? known->second.std_error : range_of(SearchRange{}, name);
  }

  /// No longer calls a parameter free.
  void remove(std::size_t at) {
    std::vector<std::size_t> rest(free_.size());
    std::iota(rest.begin(), rest.end(), std::size_t{0});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
    covariance_ = Eigen::MatrixXd(covariance_(rest, rest));
    free_.erase(free_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  /// On the surfaces as they were looked for, and once more on those that count.
  ///
  /// @return  whether beams count otherwise from now on
  bool tell_noise(const BeamsView& placed) {
    constexpr int kTimes = 2;
    if (last_step_ > kSmallStep || told_ == kTimes) return false;
    ++told_;
    const bool weighed_alike = noise_.empty();
    noise_ = relative_noise(found_, placed, sample_.beams, settings_.surfels);
    return !noise_.empty() || !weighed_alike;
  }

  /// Chosen anew while the parameters move, and kept in the end, so that the steps come to one.
  Surfels steady_ones(const Surfels& found, const BeamsView& beams) {
    if (last_step_ > kSmallStep || steady_.size() != found.surfels.size()) {
      steady_ = steady(found, beams, settings_.surfels.noise);
    }
    return kept(found, steady_);
  }

  std::vector<std::string> lasers() const {
    std::vector<std::string> names;
    for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
      const std::string& lambda = model_.names()[slot(model_, laser, kLambda)];
      names.push_back(lambda.substr(0, lambda.rfind('.')));
    }
    return names;
  }

  SensorModel start_;
  SensorModel model_;
  Sample sample_;
  std::vector<std::size_t> free_;
  std::vector<bool> steady_;  // of the surfels
  std::vector<float> noise_;  // of the beams, beside one another
  int told_ = 0;
  std::unique_ptr<FlatSurfaces> surfaces_;
  const RefinementSettings& settings_;
  Surfels all_;    // in the last round
  Surfels found_;  // of them those that count
  NormalEquations equations_;
  Eigen::MatrixXd information_;
  Eigen::MatrixXd covariance_;
  double last_step_ = std::numeric_limits<double>::infinity();
};

/// One laser that has not come round to see surfaces from its other side, too, has only their flatness to go
/// by, and takes what is not flat for an error of its own.
std::optional<std::string> doubt_of_half_a_turn(const SensorModel& model, const Sample& sample) {
  const double way = turned(sample);
  if (model.lasers() > 1 || way > 0.98 * std::numbers::pi) return std::nullopt;
  return fmt::format(
      "the plate turned by {:.0f} degrees only: one laser then sees no surface twice, and how flat surfaces "
      "are "
      "is all that tells where it sits",
      way * 180 / std::numbers::pi);
}

/// The model with what is held where the rig has it, if the rig says how well it is known.
SensorModel with_nominal(const SensorModel& model, const std::vector<Unobservable>& held,
                         const SearchRange& prior) {
  SensorModel result = model;
  for (const Unobservable& each : held) {
    if (!prior.nominal.contains(each.parameter)) continue;
    const std::size_t parameter = model.index(each.parameter);
    result = with_one(result, parameter, centres_of(prior, model, {parameter})[0]);
  }
  return result;
}

Refinement refine_once(const SensorModel& start, const Sample& sample, const RefinementSettings& settings,
                       const RoundReporter& report) {
  const LagRange lag = lag_range(start, settings.prior.eta);
  Sample inside = covered(sample, lag.earliest, lag.latest);
  const auto doubt = doubt_of_half_a_turn(start, inside);
  FreeParameters parameters =
      can_be_told(free_parameters(start, inside.beams, settings.fixed, settings.terms, settings.forms), start,
                  inside, SearchRange{});
  auto surfaces = is_in_plane(inside) ? upright_walls(settings.surfels) : patches(settings.surfels);
  Refiner refiner(with_nominal(start, parameters.unobservable, settings.prior), std::move(inside),
                  parameters.free, std::move(surfaces), settings);
  int round = 0;
  bool converged = false;
  while (!converged && round < settings.max_rounds && !refiner.free().empty()) {
    if (report && !report(round)) break;
    converged = refiner.step();
    ++round;
    for (auto& lost : refiner.hold_unknown()) {
      parameters.unobservable.push_back(std::move(lost));
      converged = false;  // the others take one more step without it
    }
  }
  if (refiner.free().empty()) throw Error("these data determine none of the parameters");
  refiner.widen_by_shared_errors();
  refiner.consider_held(parameters.unobservable);
  Refinement result = refiner.result();
  if (round > 0) check_errors(result.outcome, sample.beams, settings.surfels.floor, settings.prior);
  result.outcome.unobservable = std::move(parameters.unobservable);
  if (doubt) result.outcome.doubts.push_back(*doubt);
  result.rounds = round;
  result.converged = converged;
  if (!converged && round == settings.max_rounds) {
    result.outcome.doubts.push_back(
        fmt::format("the refinement still moved after {} rounds: its standard errors are too small", round));
  }
  return result;
}

/// The free parameters that a refinement moved by more than twice what its start was trusted to, in words.
std::vector<std::string> far_moves(const SensorModel& start, const Outcome& found, const SearchRange& prior) {
  constexpr double kFar = 2;
  std::map<std::string, ShownUnit> units;
  const Calibration calibration = found.model.calibration();
  for_each_parameter(calibration, [&](const std::string& name, const Parameter& parameter) {
    units[name] = shown_unit(parameter.unit);
  });
  const Eigen::VectorXd trusted = kFar * ranges_of(prior, start, found.free);
  const Eigen::VectorXd from = picked(start, found.free);
  const Eigen::VectorXd to = picked(found.model, found.free);
  std::vector<std::string> moves;
  for (Eigen::Index k = 0; k < from.size(); ++k) {
    const std::string& name = start.names()[found.free[static_cast<std::size_t>(k)]];
    if (std::abs(to[k] - from[k]) <= trusted[k] || prior.nominal.contains(name)) continue;
    const ShownUnit& unit = units.at(name);
    moves.push_back(fmt::format("{} moved from {:.4g} to {:.4g} {}, by more than {:.3g} {}", name,
                                from[k] * unit.factor, to[k] * unit.factor, unit.name,
                                trusted[k] * unit.factor, unit.name));
  }
  return moves;
}

/// Whether the start, which counts as an observation, draws a parameter from where the data have it by a good
/// part of its standard error: (x − x₀) · s²/p² for a standard deviation p of the start.
bool is_drawn_to_start(const SensorModel& start, const Outcome& found, const SearchRange& prior) {
  constexpr double kMuch = 0.2;
  const Eigen::VectorXd trusted = ranges_of(prior, start, found.free);
  const Eigen::VectorXd moved = picked(found.model, found.free) - picked(start, found.free);
  for (Eigen::Index k = 0; k < moved.size(); ++k) {
    if (prior.nominal.contains(start.names()[found.free[static_cast<std::size_t>(k)]])) continue;
    const double error = std::sqrt(found.covariance(k, k));
    const bool is_lag = start.names()[found.free[static_cast<std::size_t>(k)]].ends_with(".eta");
    if (is_lag && std::abs(moved[k]) > 0.99 * trusted[k]) return true;  // where the covered lags may end
    if (std::abs(moved[k]) > 2 * trusted[k]) return true;
    if (std::abs(moved[k]) * error > kMuch * trusted[k] * trusted[k]) return true;
  }
  return false;
}

}  // namespace

Refinement refine_by_surfels(const SensorModel& start, const Sample& sample,
                             const RefinementSettings& settings, const RoundReporter& report) {
  constexpr int kRestarts = 3;
  const auto was_stopped = [&](const Refinement& refinement) {
    return !refinement.converged && refinement.rounds < settings.max_rounds;
  };
  Refinement result = refine_once(start, sample, settings, report);
  SensorModel from = start;
  // The start counts as an observation: a start that was far off would draw the result towards itself.
  for (int restart = 0; restart < kRestarts; ++restart) {
    const bool is_settled = result.converged && !is_drawn_to_start(from, result.outcome, settings.prior);
    if (was_stopped(result) || is_settled) return result;
    from = result.outcome.model;
    Refinement next = refine_once(from, sample, settings, report);
    if (was_stopped(next)) return result;
    result = std::move(next);
    result.restarts = restart + 1;
  }
  for (const std::string& move : far_moves(from, result.outcome, settings.prior)) {
    result.outcome.doubts.push_back(fmt::format(
        "the refinement did not settle: {} in its last of {} restarts. Check the rig's mount and nominal "
        "values, or start from a better calibration (calibrate.load)",
        move, kRestarts));
  }
  return result;
}

}  // namespace crisp
