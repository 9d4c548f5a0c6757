// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/bound_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plugins/study/parameter_kind.hpp"

namespace crisp::study {
namespace {

/// The identifiable combination in place of an unobservable parameter.
std::string known_instead(const SceneBound& bound, const std::string& parameter) {
  const auto found = std::ranges::find(bound.unobservable, parameter, &Unobservable::parameter);
  return found == bound.unobservable.end() ? "" : found->combination;
}

/// Standard error of a parameter by calibrate.refine [SI], if that is a number.
std::optional<double> refined_error(const std::optional<RefinementAccuracy>& refinement,
                                    std::size_t parameter) {
  if (!refinement || !refinement->failure.empty()) return {};
  const double error = refinement->std_errors[static_cast<Eigen::Index>(parameter)];
  return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

}  // namespace

std::string bound_text(const SceneBound& bound, const std::optional<RefinementAccuracy>& refinement) {
  std::string text = fmt::format("{:<14}{:>20}{:>20}{}", "parameter", "least standard error",
                                 "with encoder steps", refinement ? "   calibrate.refine" : "");
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const std::string& parameter = bound.parameters[k];
    const ParameterKind& kind = kind_of(parameter);
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)] / kind.in_si;
    text += fmt::format("\n{:<14}", parameter);
    if (std::isfinite(error)) {
      const double with_steps = bound.with_steps[static_cast<Eigen::Index>(k)] / kind.in_si;
      text += fmt::format("{:>16.4f} {:<3}{:>16.4f} {:<3}", error, kind.unit, with_steps, kind.unit);
      if (const auto estimated = refined_error(refinement, k)) {
        text += fmt::format("{:>15.4f} {}", *estimated / kind.in_si, kind.unit);
      }
      continue;
    }
    const std::string instead = known_instead(bound, parameter);
    text +=
        fmt::format("{:>20}{}", "not determined", instead.empty() ? "" : "; determined [SI] is " + instead);
  }
  if (refinement && !refinement->failure.empty()) text += "\ncalibrate.refine: " + refinement->failure;
  return text;
}

std::string bound_csv(const SceneBound& bound, const std::optional<RefinementAccuracy>& refinement) {
  std::string text = "parameter,unit,std_error,std_error_with_steps,refined_std_error,known_instead\n";
  for (std::size_t k = 0; k < bound.parameters.size(); ++k) {
    const std::string& parameter = bound.parameters[k];
    const double error = bound.std_errors[static_cast<Eigen::Index>(k)];
    const auto estimated = refined_error(refinement, k);
    text += fmt::format("{},{},", parameter, kind_of(parameter).si);
    text += (std::isfinite(error)
                 ? fmt::format("{:.6g},{:.6g},", error, bound.with_steps[static_cast<Eigen::Index>(k)])
                 : ",,") +
            (estimated ? fmt::format("{:.6g},", *estimated) : ",");
    text += std::isfinite(error) ? "\n" : fmt::format("\"{}\"\n", known_instead(bound, parameter));
  }
  return text;
}

}  // namespace crisp::study
