// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/effect_resolution.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <utility>

#include "pipeline/statistics/dense_solvers.hpp"
#include "plugins/diagnose/model/competing_causes.hpp"
#include "plugins/diagnose/model/conditional_score_test.hpp"
#include "plugins/diagnose/model/score_test.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// p × q: observable directions of p parameters that change ranges by 1 m each, uncorrelated in that.
Eigen::MatrixXd shown_directions(const quality::NormalEquations& left) {
  Eigen::MatrixXd some = observable_directions(left.matrix, left.squares);
  if (some.cols() == 0) return some;
  const Eigen::VectorXd in_ranges = left.range_squares / std::max(1.0, left.changed.maxCoeff());
  const statistics::SymmetricEigen sizes =
      statistics::eigendecomposition(some.transpose() * in_ranges.asDiagonal() * some);
  return some * sizes.vectors * sizes.values.cwiseSqrt().cwiseInverse().asDiagonal();
}

/// [m] Size of the effect that gains so much in the direction that gains least, where unobservable directions
/// gain nothing.
double size_of(double gain, const quality::NormalEquations& left, const Eigen::MatrixXd& directions) {
  if (directions.cols() == 0) return kInfinity;
  const Eigen::MatrixXd steps =
      observable_directions(left.matrix, left.squares).transpose() * left.matrix * directions;
  const statistics::SymmetricEigen gains = statistics::eigendecomposition(steps.transpose() * steps);
  constexpr double kLargest = 0.5;  // [m] who has larger errors has no scanner
  const double least = gains.values[0];
  const double size = least > 0 ? std::sqrt(gain / least) : kInfinity;
  return size < kLargest ? size : kInfinity;
}

class Resolver {
 public:
  Resolver(const CandidateJacobian& jacobian, const quality::NormalEquations& equations,
           const SelectionSettings& settings)
      : jacobian_(jacobian), equations_(equations), settings_(settings), competition_(jacobian, equations) {}

  EffectResolution of(std::size_t one) const {
    const Candidate& candidate = jacobian_.candidates()[one];
    const std::vector<std::size_t> known = others_in_model(one);
    const quality::NormalEquations left = equations_given(known, {one}, jacobian_, equations_);
    const Eigen::MatrixXd directions = shown_directions(left);
    const double factor = equations_.covariance_factor();
    const double price = static_cast<double>(directions.cols()) * std::log(static_cast<double>(left.beams)) +
                         price_of_forms({one}, jacobian_, left.beams);
    const double significant = std::max(std::max(settings_.bic + price, settings_.untested) * factor,
                                        std::pow(settings_.visible, 2) * equations_.weight);
    EffectResolution result{.cause = candidate.cause_name(),
                            .detectable = size_of(significant, left, directions)};
    result.resolvable = result.detectable;
    name_parameter(result, one, left);
    if (!std::isfinite(result.detectable)) return result;
    std::map<std::string, double> sizes;  // from which on a cause cannot stand in its place
    for (std::vector<std::size_t> others : competition_.replacements_of(one)) {
      if (std::ranges::find(known, others.front()) != known.end()) continue;
      double& size = sizes[jacobian_.candidates()[others.front()].cause_name()];
      std::ranges::copy_if(known, std::back_inserter(others),
                           [&](std::size_t k) { return std::ranges::find(others, k) == others.end(); });
      const quality::NormalEquations rest = equations_given(others, {one}, jacobian_, equations_);
      size = std::max(size, size_of((settings_.odds + price) * factor, rest, directions));
      if (candidate.is_level_of(jacobian_.candidates()[others.front()]))
        size = std::max(size, level_size(others.front()));
    }
    add_confounded(result, sizes);
    return result;
  }

 private:
  /// Candidates of other causes that the model has: they are estimated as well.
  std::vector<std::size_t> others_in_model(std::size_t one) const {
    const auto& candidates = jacobian_.candidates();
    std::vector<std::size_t> others;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      if (candidates[c].in_model && !candidates[c].is_of_family(candidates[one])) others.push_back(c);
    }
    return others;
  }

  /// [m] Size of a level from which on its cause's curve is none: see Competition.
  double level_size(std::size_t curve) const {
    const quality::NormalEquations left = equations_given({}, {curve}, jacobian_, equations_);
    const Eigen::MatrixXd directions = shown_directions(left);
    if (directions.cols() < left.matrix.cols()) return kInfinity;
    const Eigen::MatrixXd errors = statistics::inverse(directions.transpose() * left.matrix * directions);
    return Competition::kCurveErrors / Competition::kPartOfLevel *
           std::sqrt(errors.trace() * equations_.covariance_factor());
  }

  static void add_confounded(EffectResolution& result, const std::map<std::string, double>& sizes) {
    std::vector<std::pair<double, std::string>> larger;
    for (const auto& [cause, size] : sizes) {
      if (size > result.detectable) larger.emplace_back(size, cause);
    }
    std::ranges::sort(larger, std::greater{});
    if (!larger.empty()) result.resolvable = larger.front().first;
    for (const auto& [size, cause] : larger) result.confounded_with.push_back(cause);
  }

  void name_parameter(EffectResolution& result, std::size_t one, const quality::NormalEquations& left) const {
    const bool has_forms = jacobian_.candidates()[one].forms > 1;
    if (left.vector.size() != 1 || has_forms || !(left.range_squares[0] > 0)) return;
    const std::string& name = jacobian_.names()[jacobian_.of(one).front()];
    for (const Parameter& parameter : jacobian_.candidates()[one].term.parameters) {
      if (!name.ends_with("." + parameter.name)) continue;
      result.parameter = parameter.name;
      result.unit = parameter.unit;
      result.per_metre = std::sqrt(left.changed[0] / left.range_squares[0]);
    }
  }

  const CandidateJacobian& jacobian_;
  const quality::NormalEquations& equations_;
  const SelectionSettings& settings_;
  Competition competition_;
};

/// Adds a cause's resolution; of one with several formulas the worst counts.
void add(EffectResolution one, std::vector<EffectResolution>& all) {
  const auto known = std::ranges::find(all, one.cause, &EffectResolution::cause);
  if (known == all.end())
    all.push_back(std::move(one));
  else if (one.resolvable > known->resolvable)
    *known = std::move(one);
}

/// Whether it is in the middle one of its forms, or in that of the model.
bool is_typical(const Candidate& candidate) {
  const std::size_t middle = candidate.forms / 2;
  return candidate.in_model || candidate.form == static_cast<double>(middle);
}

}  // namespace

std::vector<Candidate> typical_causes(std::vector<Candidate> all) {
  std::erase_if(all, [](const Candidate& one) {
    return !one.in_model && (!one.is_cause() || one.is_fine || !is_typical(one));
  });
  return all;
}

std::vector<EffectResolution> effect_resolutions(const CandidateJacobian& jacobian,
                                                 const quality::NormalEquations& equations,
                                                 const SelectionSettings& settings,
                                                 const std::function<bool(const Candidate&)>& is_wanted) {
  const Resolver resolver(jacobian, equations, settings);
  std::vector<EffectResolution> all;
  for (std::size_t c = 0; c < jacobian.candidates().size(); ++c) {
    const Candidate& one = jacobian.candidates()[c];
    if (one.is_cause() && !one.is_shape() && !one.is_fine && is_typical(one) && is_wanted(one))
      add(resolver.of(c), all);
  }
  return all;
}

quality::NormalEquations planned_with(quality::NormalEquations equations, double beams) {
  const double times = beams / static_cast<double>(equations.beams);
  equations.matrix *= times;
  equations.squares *= times;
  equations.range_squares *= times;
  equations.changed *= times;
  equations.vector.setZero();
  equations.chi2 = 0;
  equations.degrees_of_freedom *= times;
  equations.beams = static_cast<std::size_t>(beams);
  equations.weight = equations.influence = equations.stiffness = beams;
  return equations;
}

}  // namespace crisp::diagnose
