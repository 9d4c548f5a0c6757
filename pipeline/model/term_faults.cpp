// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/term_faults.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <crisp/error.hpp>

namespace crisp::model {
namespace {

/// An estimate may lie on its bound, and the optimiser's a hair beyond.
constexpr double kBeyond = 1e-6;  // of the bounds' distance

bool within(double value, const EffectParameter& declared) {
  if (!(declared.lower < declared.upper)) return true;  // a plugin's term that declares none
  const double margin = kBeyond * (declared.upper - declared.lower);
  return value >= declared.lower - margin && value <= declared.upper + margin;
}

TermFault unknown(const TermParameters& given, const TermRegistry& terms) {
  try {
    terms.get(given.term);
  } catch (const Error& error) {
    return {"", error.message(), error.advice() + "; load a plugin's with --plugin FILE"};
  }
  return {};
}

std::vector<TermFault> out_of_bounds(const TermParameters& given, const TermInfo& info) {
  std::vector<TermFault> faults;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const auto& declared = info.parameters[i];
    const double value = given.parameters[i].value;
    if (within(value, declared)) continue;
    faults.push_back({declared.name, fmt::format("{:g} {} is implausible", value, declared.unit),
                      fmt::format("{} of {} is from {:g} to {:g} {}", declared.name, given.term,
                                  declared.lower, declared.upper, declared.unit)});
  }
  return faults;
}

}  // namespace

std::vector<TermFault> faults_of(const TermParameters& given, const TermInfo& term) {
  const bool same = std::equal(
      term.parameters.begin(), term.parameters.end(), given.parameters.begin(), given.parameters.end(),
      [](const auto& declared, const auto& have) { return declared.name == have.name; });
  if (!same) {
    std::string expected;
    for (const auto& parameter : term.parameters) {
      expected += (expected.empty() ? "" : ", ") + parameter.name;
    }
    return {{"", "the calibration's parameters of " + term.name + " are not those of the term",
             "expected " + expected}};
  }
  std::vector<TermFault> faults;
  for (std::size_t i = 0; i < term.parameters.size(); ++i) {
    const auto& declared = term.parameters[i];
    const auto& have = given.parameters[i];
    if (have.unit.empty() || have.unit == declared.unit) continue;  // made in a program, without words
    faults.push_back({have.name,
                      fmt::format("'{}' is not the unit of {}'s {}", have.unit, term.name, have.name),
                      "convert the value to " + declared.unit});
  }
  return faults;
}

JudgeTerm judge_by(const TermRegistry& terms) {
  return [&terms](const TermParameters& given, TermOwner owner) -> std::vector<TermFault> {
    if (!terms.knows(given.term)) return {unknown(given, terms)};
    const auto term = terms.get(given.term);
    const Scope scope = owner == TermOwner::laser ? Scope::kLaser : Scope::kPlate;
    if (term->info().scope != scope) {
      return {{"", "the term " + given.term + " is under the wrong heading of the calibration",
               owner == TermOwner::laser ? "put it under plate" : "put it under each laser"}};
    }
    auto faults = faults_of(given, term->info());
    return faults.empty() ? out_of_bounds(given, term->info()) : faults;
  };
}

}  // namespace crisp::model
