// SPDX-License-Identifier: BSD-3-Clause
// The covariance of a surfel refinement: what it does not determine, what beams share, what held parameters
// add.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/encoder_quantization.hpp"
#include "pipeline/estimate/observability.hpp"
#include "pipeline/estimate/shared_errors.hpp"
#include "pipeline/estimate/surfel_jacobian.hpp"
#include "pipeline/estimate/surfel_refiner.hpp"
#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::estimate {
namespace {

constexpr double kMatters = 0.1;  // of an error as a drawing has: 0.5 mm, 0.1°, 0.1 ms

/// Standard deviation of a value that was read off a drawing, or estimated by a person who knows the devices.
double of_a_drawing(const std::string& name) {
  if (name.ends_with(".tau")) return 5e-3;
  if (name.ends_with(".eta")) return 1e-3;
  return 1 * data::kDegree;
}

}  // namespace

std::vector<Unobservable> SurfelRefiner::hold_unobservable() {
  if (!surfaces_->is_settled()) return {};
  // The rig's knowledge is one more observation, and never has to be held.
  constexpr double kNeverHeld = 10;
  Eigen::MatrixXd information = information_;
  Eigen::VectorXd ranges = ranges_of(settings_.prior, model_, free_);
  for (std::size_t k = 0; k < free_.size(); ++k) {
    if (!settings_.prior.nominal.contains(model_.names()[free_[k]])) continue;
    const auto i = static_cast<Eigen::Index>(k);
    information(i, i) += 1 / (ranges[i] * ranges[i]);
    ranges[i] *= kNeverHeld;
  }
  auto determined = observability(information, free_, model_.names(), ranges);
  if (determined.unobservable.empty()) return {};
  const SensorModel found = model_;
  model_ = with(start_, determined.known, picked(found, determined.known));
  free_ = determined.known;
  return determined.unobservable;
}

void SurfelRefiner::widen_by_shared_errors() {
  if (found_.surfels.empty()) return;
  constexpr double kNoStep = 0;  // widening_by_quantization() accounts for the encoder's steps
  const PlacedBeams placed(model_, sample_);
  const auto equations = quality::normal_equations(
      found_, placed.view(noise_), free_.size(), surfel_rows(model_, sample_, free_), settings_.surfels,
      shared_errors(sample_, found_, placed.view(noise_), kNoStep));
  const Eigen::VectorXd of_prior =
      covariance_.diagonal().cwiseQuotient(ranges_of(settings_.prior, model_, free_).cwiseAbs2());
  covariance_ = widened(covariance_, widening_with_prior(widening(equations), of_prior));
  if (settings_.angle_step > 0) covariance_ = widened(covariance_, widening_by_quantization(equations));
}

void SurfelRefiner::consider_held(std::vector<Unobservable>& unobservable) {
  if (unobservable.empty() || found_.surfels.empty()) return;
  std::vector<std::size_t> all_held;
  Eigen::VectorXd prior(static_cast<Eigen::Index>(unobservable.size()));
  bool is_from_rig = true;
  for (const Unobservable& held : unobservable) {
    prior[static_cast<Eigen::Index>(all_held.size())] = prior_of_held(held.parameter);
    is_from_rig = is_from_rig && settings_.prior.nominal.contains(held.parameter);
    all_held.push_back(model_.index(held.parameter));
  }
  ConsiderCovariance considered = consider_with(all_held, prior);
  covariance_ = std::move(considered.covariance);
  if (is_from_rig) return;  // then the standard errors state the uncertainty of all parameters
  for (Unobservable& lost : considered.dependent) {
    const std::size_t at =
        static_cast<std::size_t>(std::ranges::find(free_, model_.index(lost.parameter)) - free_.begin());
    remove(at);
    unobservable.push_back(std::move(lost));
  }
}

std::optional<std::string> SurfelRefiner::consider_fixed(const std::vector<std::size_t>& fixed) {
  if (fixed.empty() || free_.empty() || found_.surfels.empty()) return std::nullopt;
  Eigen::VectorXd of_rig = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fixed.size()));
  Eigen::VectorXd assumed = of_rig;
  for (std::size_t k = 0; k < fixed.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto known = settings_.prior.nominal.find(model_.names()[fixed[k]]);
    if (known != settings_.prior.nominal.end())
      of_rig[i] = known->second.std_error;
    else
      assumed[i] = of_a_drawing(model_.names()[fixed[k]]);
  }
  covariance_ = consider_with(fixed, of_rig).covariance;
  const ConsiderCovariance considered = consider_with(fixed, assumed);
  const Eigen::VectorXd moves = (considered.covariance - covariance_).diagonal().cwiseMax(0).cwiseSqrt();
  std::vector<std::string> known;
  for (const Unobservable& dependent : considered.dependent) {
    const auto at = std::ranges::find(free_, model_.index(dependent.parameter)) - free_.begin();
    if (moves[at] > kMatters * of_a_drawing(dependent.parameter)) known.push_back(dependent.combination);
  }
  if (known.empty()) return std::nullopt;
  constexpr std::size_t kShown = 3;
  const std::string more =
      known.size() > kShown ? fmt::format(" and {} more", known.size() - kShown) : std::string();
  known.resize(std::min(known.size(), kShown));
  return fmt::format(
      "these data determine combinations with fixed parameters only, whose uncertainty the rig does not give: {}{}. An error of a fixed value is an error of the others, beyond their standard errors. Give each fixed parameter its sd in the rig, or estimate it",
      fmt::join(known, ", "), more);
}

/// The covariance with what parameters that are held add to it.
///
/// @param prior  their standard deviations
ConsiderCovariance SurfelRefiner::consider_with(const std::vector<std::size_t>& held,
                                                const Eigen::VectorXd& prior) const {
  std::vector<std::size_t> all = free_;
  all.insert(all.end(), held.begin(), held.end());
  std::vector<std::string> names;
  for (const std::size_t parameter : all) names.push_back(model_.names()[parameter]);
  const PlacedBeams placed(model_, sample_);
  const auto equations = quality::normal_equations(found_, placed.view(noise_), all.size(),
                                                   surfel_rows(model_, sample_, all), settings_.surfels);
  return consider(covariance_, equations.matrix, names, prior);
}

/// The factors by which standard errors grow since beams share the errors of the encoder's steps.
///
/// @param without  the equations as if they did not
Eigen::VectorXd SurfelRefiner::widening_by_quantization(const quality::NormalEquations& without) const {
  const PlacedBeams placed(model_, sample_);
  const auto noise = noise_with_quantization(found_, placed.view(noise_), sample_, settings_.angle_step,
                                             settings_.surfels.noise);
  const auto with = quality::normal_equations(found_, placed.view(noise), free_.size(),
                                              surfel_rows(model_, sample_, free_), settings_.surfels);
  const Eigen::VectorXd prior = ranges_of(settings_.prior, model_, free_).cwiseAbs2().cwiseInverse();
  const auto variances = [&](const quality::NormalEquations& equations) -> Eigen::VectorXd {
    const Eigen::MatrixXd information = equations.matrix / without.covariance_factor();
    return statistics::inverse(information + Eigen::MatrixXd(prior.asDiagonal())).diagonal();
  };
  return variances(with).cwiseQuotient(variances(without)).cwiseSqrt().cwiseMax(1);
}

double SurfelRefiner::prior_of_held(const std::string& name) const {
  const auto known = settings_.prior.nominal.find(name);
  return known != settings_.prior.nominal.end() ? known->second.std_error : range_of(ParameterPrior{}, name);
}

/// Removes a parameter from the free ones.
void SurfelRefiner::remove(std::size_t at) {
  std::vector<std::size_t> rest(free_.size());
  std::iota(rest.begin(), rest.end(), std::size_t{0});
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
  covariance_ = Eigen::MatrixXd(covariance_(rest, rest));
  free_.erase(free_.begin() + static_cast<std::ptrdiff_t>(at));
}

}  // namespace crisp::estimate
