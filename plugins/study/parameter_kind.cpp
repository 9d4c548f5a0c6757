// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/parameter_kind.hpp"

#include <algorithm>
#include <array>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/internal_error.hpp"

namespace crisp::study {

std::span<const ParameterKind> parameter_kinds() {
  static const std::array<ParameterKind, 4> kinds = {{{"lambda", "deg", "rad", data::kDegree},
                                                      {"tau", "mm", "m", 1e-3},
                                                      {"alpha", "deg", "rad", data::kDegree},
                                                      {"eta", "ms", "s", 1e-3}}};
  return kinds;
}

const ParameterKind& kind_of(const std::string& parameter) {
  const std::string name = parameter.substr(parameter.rfind('.') + 1);
  const auto found = std::ranges::find(parameter_kinds(), name, &ParameterKind::name);
  if (found == parameter_kinds().end())
    throw data::internal_error("no calibration estimates the parameter " + parameter);
  return *found;
}

}  // namespace crisp::study
