// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace crisp {

/// How parameters of one name, λ, τ, α or η, are told to people.
struct ParameterKind {
  std::string name;  ///< "tau"
  std::string unit;  ///< "mm"
  std::string si;    ///< "m"
  double in_si = 1;  ///< one of the unit
};

/// λ, τ, α, η.
std::span<const ParameterKind> parameter_kinds();

/// That of "laser1.tau".
const ParameterKind& kind_of(const std::string& parameter);

}  // namespace crisp
