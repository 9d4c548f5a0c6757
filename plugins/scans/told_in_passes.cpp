// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/told_in_passes.hpp"

#include <algorithm>
#include <cmath>

#include "plugins/scans/about_level.hpp"

namespace crisp {
namespace {

LikenessLook look_at(const char* covariate, const std::vector<ValueWithError>& values, Level level,
                     std::size_t blocks) {
  const AboutLevel about = about_level(values, level, blocks);
  LikenessLook look{.covariate = covariate, .quantity = "plate angle", .unit = "rad"};
  if (!about.compared) return look;
  look.amplitude = std::sqrt(std::max(0.0, about.beyond)) / 2;
  look.p_value = about.p_value;
  return look;
}

}  // namespace

ToldApart told_in_passes(const PassShift& shift, bool taken_out) {
  const auto looks = [&](Level level, const ValueWithError& in_all) {
    return corrected({look_at("plate angle", shift.by_angle, level, kPassBlocks / shift.by_angle.size()),
                      look_at("mirror angle", shift.by_beam, level, kPassBlocks / shift.by_beam.size()),
                      look_at("direction of the actuator", {in_all}, Level::kZero, kPassBlocks)});
  };
  const Likeness plain = looks(Level::kZero, {shift.shift, shift.std_error});
  if (!taken_out) return {.scope = "plate", .before = plain, .after = plain};
  const auto [fitted, fitted_error] = shift.fitted;
  const auto [other, other_error] = shift.held_out;
  const ValueWithError left(other - fitted, std::hypot(fitted_error, other_error));
  return {.scope = "plate", .before = plain, .after = looks(Level::kMean, left)};
}

}  // namespace crisp
