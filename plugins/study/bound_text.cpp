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

/// What calibrate.refine reaches of a parameter [SI], if that is a number.
std::optional<double> reached_error(const std::optional<Reached>& reached, std::size_t parameter) {
  if (!reached || !reached->failure.empty()) return {};
  const double error = reached->std_errors[static_cast<Eigen::Index>(parameter)];
  return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

}  // namespace

std::string bound_text(const SceneBound& bound, const std::optional<Reached>& reached) {
  std::string text = fmt::format("{:<14}{:>20}{:>20}{}", "parameter", "least standard error",
                                 "with encoder steps", reached ? "   calibrate.refine" : "");
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const std::string& parameter = bound.parameters[k];
    const ParameterKind& kind = kind_of(parameter);
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)] / kind.in_si;
    text += fmt::format("\n{:<14}", parameter);
    if (std::isfinite(error)) {
      const double with_steps = bound.with_steps[static_cast<Eigen::Index>(k)] / kind.in_si;
      text += fmt::format("{:>16.4f} {:<3}{:>16.4f} {:<3}", error, kind.unit, with_steps, kind.unit);
      if (const auto claimed = reached_error(reached, k)) {
        text += fmt::format("{:>15.4f} {}", *claimed / kind.in_si, kind.unit);
      }
      continue;
    }
    const std::string instead = known_instead(bound, parameter);
    text += fmt::format("{:>20}{}", "not determined",
                        instead.empty() ? "" : "; what is known [SI] is " + instead);
  }
  if (reached && !reached->failure.empty()) text += "\ncalibrate.refine: " + reached->failure;
  return text;
}

std::string bound_csv(const SceneBound& bound, const std::optional<Reached>& reached) {
  std::string text = "parameter,unit,std_error,std_error_with_steps,refined_std_error,known_instead\n";
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const std::string& parameter = bound.parameters[k];
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)];
    const auto claimed = reached_error(reached, k);
    text += fmt::format("{},{},", parameter, kind_of(parameter).si);
    text += (std::isfinite(error)
                 ? fmt::format("{:.6g},{:.6g},", error, bound.with_steps[static_cast<Eigen::Index>(k)])
                 : ",,") +
            (claimed ? fmt::format("{:.6g},", *claimed) : ",");
    text += std::isfinite(error) ? "\n" : fmt::format("\"{}\"\n", known_instead(bound, parameter));
  }
  return text;
}

}  // namespace crisp
