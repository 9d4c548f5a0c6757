// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace crisp::study {

/// Name, unit and format of the parameters λ, τ, α or η for people.
struct ParameterKind {
  std::string name;  ///< "tau"
  std::string unit;  ///< "mm"
  std::string si;    ///< "m"
  double in_si = 1;  ///< one of the unit
};

/// λ, τ, α, η.
std::span<const ParameterKind> parameter_kinds();

/// The kind of a parameter such as "laser1.tau".
const ParameterKind& kind_of(const std::string& parameter);

}  // namespace crisp::study
