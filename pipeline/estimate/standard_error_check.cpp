// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/standard_error_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "pipeline/data/internal_error.hpp"

namespace crisp::estimate {

void check_errors(const Outcome& outcome, const Measurements& beams, double floor,
                  const ParameterPrior& prior) {
  constexpr double kFastest = 2 * std::numbers::pi * 100;  // [rad/s] of a plate
  const double farthest = beams.range.empty() ? 0 : *std::ranges::max_element(beams.range);
  const double across = floor / std::sqrt(static_cast<double>(std::max<std::size_t>(1, beams.size())));
  const std::map<std::string, double> most = {// [m] by which one unit of each moves a point
                                              {".lambda", 1 + farthest},
                                              {".tau", 1},
                                              {".alpha", farthest},
                                              {".eta", kFastest * (1 + farthest)}};
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const std::string& name = outcome.model.names()[outcome.free[k]];
    if (prior.nominal.contains(name)) continue;
    const auto kind = most.find(name.substr(name.find('.')));
    const auto i = static_cast<Eigen::Index>(k);
    if (kind == most.end() || outcome.covariance(i, i) >= std::pow(across / kind->second, 2)) continue;
    throw data::internal_error(
        fmt::format("{} has a standard error of {:.2g}, less than the beams' noise allows", name,
                    std::sqrt(outcome.covariance(i, i))));
  }
}

}  // namespace crisp::estimate
