// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include <crisp/error.hpp>
#include <crisp/sensor_model.hpp>

#include "pipeline/data/internal_error.hpp"
#include "pipeline/model/term_faults.hpp"
#include "pipeline/model/traced_runs.hpp"

namespace crisp {
namespace {

void add_terms(LaserChain& chain, const std::vector<TermParameters>& terms, std::size_t first_value,
               Scope scope, const TermRegistry& registry) {
  for (const auto& given : terms) {
    auto term = registry.get(given.term);
    const auto faults = model::faults_of(given, term->info());
    if (!faults.empty()) throw Error(faults.front().what, faults.front().advice);
    if (term->info().scope != scope) {
      throw Error("the term " + given.term + " is under the wrong heading of the calibration",
                  scope == Scope::kLaser ? "put it under plate" : "put it under each laser");
    }
    const auto phase = static_cast<std::size_t>(term->info().phase);
    chain.phases[phase].push_back({std::move(term), chain.slots.size()});
    for (std::size_t i = 0; i < given.parameters.size(); ++i) chain.slots.push_back(first_value++);
    chain.bare = false;
  }
}

std::size_t count_parameters(const std::vector<TermParameters>& terms) {
  std::size_t n = 0;
  for (const auto& term : terms) n += term.parameters.size();
  return n;
}

void add_names(std::vector<std::string>& names, const std::string& owner,
               const std::vector<TermParameters>& terms) {
  for (const auto& term : terms) {
    for (const auto& parameter : term.parameters) {
      names.push_back(owner + "." + term.term + "." + parameter.name);
    }
  }
}

/// Calls visit(parameter) for every parameter of a calibration, in the order of SensorModel::values().
template <class AnyCalibration, class Visit>
void for_each_parameter(AnyCalibration& calibration, Visit visit) {
  const auto all = [&](auto& terms) {
    for (auto& term : terms) {
      for (auto& parameter : term.parameters) visit(parameter);
    }
  };
  for (auto& laser : calibration.lasers) {
    for (auto* parameter : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}) visit(*parameter);
    all(laser.terms);
  }
  all(calibration.plate_terms);
}

}  // namespace

SensorModel::Fixed SensorModel::resolve(Calibration calibration, const TermRegistry& terms) {
  Fixed fixed(std::move(calibration));
  std::size_t first_plate = 0;
  for_each_parameter(fixed.calibration, [&](const Parameter&) { ++first_plate; });
  first_plate -= count_parameters(fixed.calibration.plate_terms);
  std::size_t next = 0;
  for (const auto& laser : fixed.calibration.lasers) {
    for (const auto* parameter : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}) {
      fixed.names.push_back(laser.name + "." + parameter->name);
    }
    add_names(fixed.names, laser.name, laser.terms);

    LaserChain& chain = fixed.chains.emplace_back();
    chain.phases.resize(kPhases);
    for (std::size_t i = 0; i < model::kBaseParameters; ++i) chain.slots.push_back(next + i);
    add_terms(chain, laser.terms, next + model::kBaseParameters, Scope::kLaser, terms);
    add_terms(chain, fixed.calibration.plate_terms, first_plate, Scope::kPlate, terms);
    next += model::kBaseParameters + count_parameters(laser.terms);
  }
  add_names(fixed.names, "plate", fixed.calibration.plate_terms);
  return fixed;
}

SensorModel::SensorModel(Calibration calibration, const TermRegistry& terms)
    : fixed_(std::make_shared<const Fixed>(resolve(std::move(calibration), terms))) {
  std::vector<double> values;
  for_each_parameter(fixed_->calibration,
                     [&](const Parameter& parameter) { values.push_back(parameter.value); });
  values_ = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  bare_ = std::make_shared<const std::vector<simd::BareLaser>>(model::bare_lasers(fixed_->chains, values_));
}

std::size_t SensorModel::index(const std::string& name) const {
  const auto found = std::find(names().begin(), names().end(), name);
  if (found == names().end()) throw data::internal_error("the sensor model has no parameter " + name);
  return static_cast<std::size_t>(found - names().begin());
}

void SensorModel::set_values(const Eigen::VectorXd& values) {
  if (values.size() != values_.size())
    throw data::internal_error(
        fmt::format("the sensor model has {} parameters and got {} values", values_.size(), values.size()));
  values_ = values;
  bare_ = std::make_shared<const std::vector<simd::BareLaser>>(model::bare_lasers(fixed_->chains, values_));
}

Calibration SensorModel::calibration() const {
  Calibration result = fixed_->calibration;
  Eigen::Index i = 0;
  for_each_parameter(result, [&](Parameter& parameter) { parameter.value = values_[i++]; });
  return result;
}

}  // namespace crisp
