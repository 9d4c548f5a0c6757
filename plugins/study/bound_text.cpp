// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/bound_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plugins/study/parameter_kind.hpp"

namespace crisp {
namespace {

/// What is known in place of an unobservable parameter.
std::string known_instead(const SceneBound& bound, const std::string& parameter) {
  const auto found = std::ranges::find(bound.unobservable, parameter, &Unobservable::parameter);
  return found == bound.unobservable.end() ? "" : found->combination;
}

}  // namespace

std::string bound_text(const SceneBound& bound) {
  std::string text = fmt::format("{:<18}{:>20}", "parameter", "least standard error");
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const std::string& parameter = bound.parameters[k];
    const ParameterKind& kind = kind_of(parameter);
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)] / kind.in_si;
    if (std::isfinite(error)) {
      text += fmt::format("\n{:<18}{:>16.4f} {}", parameter, error, kind.unit);
      continue;
    }
    const std::string instead = known_instead(bound, parameter);
    text += fmt::format("\n{:<18}{:>20}{}", parameter, "not determined",
                        instead.empty() ? "" : "; what is known [SI] is " + instead);
  }
  return text;
}

std::string bound_csv(const SceneBound& bound) {
  std::string text = "parameter,unit,std_error,known_instead\n";
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const std::string& parameter = bound.parameters[k];
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)];
    text += fmt::format("{},{},", parameter, kind_of(parameter).si);
    text += std::isfinite(error) ? fmt::format("{:.6g},\n", error)
                                 : fmt::format(",\"{}\"\n", known_instead(bound, parameter));
  }
  return text;
}

}  // namespace crisp
