// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surfel_refiner.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/bounded_step.hpp"
#include "pipeline/estimate/incidence.hpp"
#include "pipeline/estimate/relative_noise.hpp"
#include "pipeline/estimate/static_surfaces.hpp"
#include "pipeline/estimate/surfel_jacobian.hpp"

namespace crisp::estimate {

namespace {

/// Whether the mirror of each laser sweeps: beams that were fired in one direction do not.
bool is_swept(const Measurements& beams) {
  return std::ranges::all_of(mirror_sweeps(beams),
                             [](const auto& of_laser) { return of_laser.second > kLeastSweep; });
}

}  // namespace

LagRange refined_lags(const SensorModel& start, const ParameterPrior& prior) {
  const LagRange lags = lag_range(start, prior.eta);
  return {.earliest = std::max(lags.earliest, prior.earliest_eta),
          .latest = std::min(lags.latest, prior.latest_eta)};
}

SurfelRefiner::SurfelRefiner(const SensorModel& start, Sample sample, std::vector<std::size_t> free,
                             const RefinementSettings& settings, const SurfaceMap* known)
    : start_(start), model_(start), sample_(std::move(sample)), free_(std::move(free)), settings_(settings) {
  if (is_in_plane(sample_)) {
    surfaces_ = upright_walls(settings.surfels, settings.searches);
    return;
  }
  SurfaceMap::Selection begin;
  if (known != nullptr) {
    begin = known->of(sample_.beams);
    noise_ = std::move(begin.noise);
    noise_updates_ = 1;
  }
  surfaces_ = patches(settings.surfels, settings.searches, is_swept(sample_.beams), std::move(begin.surfels));
}

bool SurfelRefiner::step() {
  const PlacedBeams placed(model_, sample_);
  const bool was_settled = surfaces_->is_settled();
  all_ = surfaces_->update(placed.view(noise_), is_moving());
  found_ = select_static(all_, placed.view(noise_));
  if (found_.surfels.empty()) {
    throw Error("these data contain no flat surface",
                "omit calibrate.refine in scenes without flat surfaces, or reduce `min_cell`");
  }
  // For terms that depend on it.
  sample_.beams.cos_incidence = incidences(found_, placed.view(noise_));
  const Eigen::VectorXd before = picked(model_, free_);
  const Eigen::VectorXd step = posterior_step(placed);
  if (was_settled)
    update_damping(step);
  else
    damping_ = 1;
  const Eigen::VectorXd after = keep_covered(before + damping_ * step);
  last_change_ = after - before;
  model_ = with(model_, free_, after);
  last_step_ = (last_change_.array() / covariance_.diagonal().array().sqrt()).abs().maxCoeff();
  last_shift_ = std::sqrt(last_change_.dot(equations_.matrix * last_change_) /
                          static_cast<double>(std::max<std::size_t>(1, equations_.beams)));
  const bool is_reweighted = update_noise(placed.view(noise_));
  return surfaces_->is_settled() && last_step_ < settings_.tolerance && !is_reweighted;
}

/// Step to where the linearized posterior is largest within the parameters' bounds; computes the information
/// and the covariance.
Eigen::VectorXd SurfelRefiner::posterior_step(const PlacedBeams& placed) {
  const auto equations = [&](const quality::Surfels& surfels) {
    return quality::normal_equations(surfels, placed.view(noise_), free_.size(),
                                     surfel_rows(model_, sample_, free_), settings_.surfels);
  };
  const bool is_all = found_.members.size() <= settings_.equation_beams;
  equations_ = is_all ? equations(found_) : equations(quality::thinned(found_, settings_.equation_beams));
  information_ = equations_.matrix / equations_.covariance_factor();
  const Eigen::VectorXd prior = ranges_of(settings_.prior, model_, free_).cwiseAbs2().cwiseInverse();
  const Eigen::VectorXd off = picked(model_, free_) - prior_means(settings_.prior, start_, free_);
  const Eigen::VectorXd gradient =
      equations_.vector / equations_.covariance_factor() + prior.cwiseProduct(off);
  const auto n = information_.rows();
  const Eigen::MatrixXd posterior = information_ + Eigen::MatrixXd(prior.asDiagonal());
  covariance_ = posterior.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  covariance_ = covariance_.selfadjointView<Eigen::Lower>();  // to the last bit
  return bounded_step(posterior, gradient, step_bounds(model_, free_));
}

/// Damps the steps by the secant method where one takes back what the step before did: where parameters are
/// nearly exchangeable, the information changes within a standard error, and full steps alternate for ever.
void SurfelRefiner::update_damping(const Eigen::VectorXd& step) {
  if (last_change_.size() != step.size()) {
    damping_ = 1;
    return;
  }
  const Eigen::VectorXd weighted = last_change_.cwiseQuotient(covariance_.diagonal());
  const double length = weighted.dot(last_change_);
  if (!(length > 0)) return;
  // Steps fall by this much over the last change, as multiples of it.
  const double slope = 1 / damping_ - weighted.dot(step) / length;
  damping_ = slope > 1 ? 1 / slope : 1;
}

Refinement SurfelRefiner::result() const {
  return {
      .outcome =
          {.model = model_, .free = free_, .covariance = covariance_, .unobservable = {}, .caveats = {}},
      .surfels = found_.surfels.size(),
      .beams = equations_.beams,
      .chi2 = equations_.chi2 / std::max(1.0, equations_.degrees_of_freedom),
      .surfaces = all_.surfels.empty() ? nullptr : std::make_shared<SurfaceMap>(sample_.beams, all_, noise_)};
}

void SurfelRefiner::compare_views(Refinement& result) const {
  if (found_.surfels.empty()) return;
  const PlacedBeams placed(model_, sample_);
  result.scatter = neighbour_noise(found_, placed.view(noise_), sample_.beams, settings_.surfels);
  std::vector<std::string> caveats;
  for (const ViewPartition& partition : view_partitions(sample_, lasers())) {
    const auto pairs = view_consistency(all_, placed.view(noise_), partition,
                                        {.range = settings_.surfels.noise, .angle = settings_.angle_error});
    if (const auto caveat = inconsistency(partition, pairs)) caveats.push_back(*caveat);
    result.views.insert(result.views.end(), pairs.begin(), pairs.end());
  }
  result.outcome.caveats.insert(result.outcome.caveats.begin(), caveats.begin(), caveats.end());
}

/// What is chosen with the parameters is kept from a small step on: beams that join and leave surfaces at
/// their rims would keep steps from getting any smaller.
bool SurfelRefiner::is_moving() const {
  constexpr double kSmallStep = 0.5;    // [standard errors]
  constexpr double kSmallShift = 0.02;  // of the noise, by which beams move to and from their surfaces (RMS)
  return last_step_ > kSmallStep && last_shift_ > kSmallShift;
}

/// Clamps each η to where encoder readings cover the beams.
Eigen::VectorXd SurfelRefiner::keep_covered(Eigen::VectorXd values) const {
  const LagRange lag = refined_lags(start_, settings_.prior);
  for (std::size_t k = 0; k < free_.size(); ++k) {
    if (!model_.names()[free_[k]].ends_with(".eta")) continue;
    double& eta = values[static_cast<Eigen::Index>(k)];
    eta = std::clamp(eta, lag.earliest, lag.latest);
  }
  return values;
}

/// Estimates the beams' relative noise on the surfaces as first found, and once more on the static ones.
///
/// @return  whether the beams' weights changed
bool SurfelRefiner::update_noise(const quality::BeamsView& placed) {
  constexpr int kTimes = 2;
  if (is_moving() || noise_updates_ == kTimes) return false;
  ++noise_updates_;
  const bool was_uniform = noise_.empty();
  noise_ = relative_noise(found_, placed, sample_.beams, settings_.surfels);
  return !noise_.empty() || !was_uniform;
}

/// Selects the static surfaces anew while the parameters move, for a few rounds on the final surfaces, and
/// then keeps the selection: two selections may each have the other's surfaces for moving at their optimum,
/// and the steps would alternate between them for ever.
quality::Surfels SurfelRefiner::select_static(const quality::Surfels& found,
                                              const quality::BeamsView& beams) {
  constexpr int kTimes = 5;
  const bool is_open = selections_ == 0 || (is_moving() && selections_ < kTimes);
  if (is_open || is_static_.size() != found.surfels.size()) {
    is_static_ = static_surfaces(found, beams, settings_.surfels.noise);
    if (surfaces_->is_settled()) ++selections_;
  }
  return kept(found, is_static_);
}

std::vector<std::string> SurfelRefiner::lasers() const {
  std::vector<std::string> names;
  for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
    const std::string& lambda = model_.names()[slot(model_, laser, kLambda)];
    names.push_back(lambda.substr(0, lambda.rfind('.')));
  }
  return names;
}

}  // namespace crisp::estimate
