// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/pass_fit_test.hpp"

#include <algorithm>
#include <cmath>

#include "plugins/diagnose/scans/homogeneity_test.hpp"

namespace crisp::diagnose {
namespace {

data::FitTest score_test(const char* covariate, const std::vector<ValueWithError>& values, Level level,
                         std::size_t blocks) {
  const HomogeneityTest about = homogeneity_test(values, level, blocks);
  data::FitTest test{.covariate = covariate, .quantity = "plate angle", .unit = "rad"};
  if (!about.compared) return test;
  test.amplitude = std::sqrt(std::max(0.0, about.beyond)) / 2;
  test.p_value = about.p_value;
  return test;
}

}  // namespace

data::GoodnessOfFit pass_fit_test(const PassOffset& shift, bool is_removed) {
  const auto tests = [&](Level level, const ValueWithError& in_all) {
    return data::corrected(
        {score_test("plate angle", shift.by_angle, level, kPassBlocks / shift.by_angle.size()),
         score_test("mirror angle", shift.by_beam, level, kPassBlocks / shift.by_beam.size()),
         score_test("direction of the actuator", {in_all}, Level::kZero, kPassBlocks)});
  };
  const data::FitStatistics plain = tests(Level::kZero, {shift.shift, shift.std_error});
  if (!is_removed) return {.scope = "plate", .before = plain, .after = plain};
  const auto [fitted, fitted_error] = shift.fitted;
  const auto [other, other_error] = shift.held_out;
  const ValueWithError left(other - fitted, std::hypot(fitted_error, other_error));
  return {.scope = "plate", .before = plain, .after = tests(Level::kMean, left)};
}

}  // namespace crisp::diagnose
