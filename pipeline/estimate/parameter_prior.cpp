// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/parameter_prior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pipeline/data/each_parameter.hpp"
#include "pipeline/estimate/requested_terms.hpp"

namespace crisp::estimate {
namespace {

constexpr double kOfBounds = 0.05;  // fraction of a term's bounds within which its parameters are searched

}  // namespace

std::map<std::string, NominalValue> nominal_values(const Rig& rig) {
  std::map<std::string, NominalValue> known;
  const Calibration nominal = nominal_calibration(rig);
  data::for_each_parameter(nominal, [&](const std::string& name, const Parameter& parameter) {
    if (parameter.std_error > 0) known[name] = {.value = parameter.value, .std_error = parameter.std_error};
  });
  return known;
}

double range_of(const ParameterPrior& range, const std::string& name) {
  const auto known = range.nominal.find(name);
  if (known != range.nominal.end()) return range.reach * known->second.std_error;
  if (name.ends_with(".lambda")) return range.lambda;
  if (name.ends_with(".tau")) return range.tau;
  if (name.ends_with(".alpha")) return range.alpha;
  if (name.ends_with(".eta")) return range.eta;
  return range.other;
}

bool is_at_the_end(const ParameterPrior& range, const std::string& name, double value) {
  constexpr double kSame = 1e-6;  // [s]
  return name.ends_with(".eta") && (value < range.earliest_eta + kSame || value > range.latest_eta - kSame);
}

Eigen::VectorXd picked(const SensorModel& model, const std::vector<std::size_t>& free) {
  return model.values()(free);
}

Eigen::VectorXd ranges_of(const ParameterPrior& range, const SensorModel& model,
                          const std::vector<std::size_t>& free) {
  Eigen::VectorXd ranges(static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::string& name = model.names()[free[i]];
    const EffectParameter* term = range.nominal.contains(name) ? nullptr : declared(model, free[i]);
    const double width = term ? term->upper - term->lower : 0;
    ranges[static_cast<Eigen::Index>(i)] = width > 0 ? kOfBounds * width : range_of(range, name);
  }
  return ranges;
}

Eigen::VectorXd centres_of(const ParameterPrior& range, const SensorModel& model,
                           const std::vector<std::size_t>& free) {
  Eigen::VectorXd centres = picked(model, free);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::string& name = model.names()[free[i]];
    const auto known = range.nominal.find(name);
    if (known == range.nominal.end()) continue;
    double& centre = centres[static_cast<Eigen::Index>(i)];
    const bool is_angle = name.ends_with(".lambda") || name.ends_with(".alpha");
    const double off = known->second.value - centre;
    centre += is_angle ? std::remainder(off, 2 * std::numbers::pi) : off;
  }
  return centres;
}

Eigen::VectorXd nominal_information(const ParameterPrior& range, const SensorModel& model,
                                    const std::vector<std::size_t>& parameters) {
  Eigen::VectorXd information = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto known = range.nominal.find(model.names()[parameters[i]]);
    if (known == range.nominal.end()) continue;
    information[static_cast<Eigen::Index>(i)] = 1 / std::pow(range.reach * known->second.std_error, 2);
  }
  return information;
}

bool is_amplitude(const SensorModel& model, std::size_t parameter) {
  const EffectParameter* term = declared(model, parameter);
  return term && !term->shape && term->upper > term->lower;
}

Eigen::VectorXd prior_means(const ParameterPrior& range, const SensorModel& start,
                            const std::vector<std::size_t>& free) {
  Eigen::VectorXd means = centres_of(range, start, free);
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (is_amplitude(start, free[i])) means[static_cast<Eigen::Index>(i)] = declared(start, free[i])->neutral;
  }
  return means;
}

SensorModel with(const SensorModel& model, const std::vector<std::size_t>& free, const Eigen::VectorXd& x) {
  Eigen::VectorXd values = model.values();
  values(free) = x;
  SensorModel moved = model;
  moved.set_values(values);
  return moved;
}

SensorModel with_one(const SensorModel& model, std::size_t parameter, double value) {
  return with(model, {parameter}, Eigen::VectorXd::Constant(1, value));
}

StepBounds step_bounds(const SensorModel& model, const std::vector<std::size_t>& free) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto n = static_cast<Eigen::Index>(free.size());
  StepBounds bounds{.lower = Eigen::VectorXd::Constant(n, -kInfinity),
                    .upper = Eigen::VectorXd::Constant(n, kInfinity)};
  const Eigen::VectorXd values = picked(model, free);
  for (Eigen::Index i = 0; i < n; ++i) {
    const EffectParameter* term = declared(model, free[static_cast<std::size_t>(i)]);
    if (!term || !(term->upper > term->lower)) continue;
    bounds.lower[i] = term->lower - values[i];
    bounds.upper[i] = term->upper - values[i];
  }
  return bounds;
}

}  // namespace crisp::estimate
