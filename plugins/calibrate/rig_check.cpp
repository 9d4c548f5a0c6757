// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/each_parameter.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "pipeline/estimate/outcome.hpp"
#include "plugins/calibrate/rig_mistakes.hpp"

namespace crisp::calibrate {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kReach = 3;  // standard deviations of a nominal value that a parameter may be off

/// Largest distance of a parameter from its nominal value, with its description.
struct Limit {
  double size = 0;     ///< 0: as far as it likes
  std::string option;  ///< of calibrate.rqe, if the rig gives no standard deviation
};

/// How far a value is above its nominal one; an angle the shorter way round.
double off_nominal(const Parameter& found, const Parameter& nominal) {
  const double difference = found.value - nominal.value;
  return nominal.unit == "rad" ? std::remainder(difference, kFullTurn) : difference;
}

Limit limit_of(const Parameter& nominal, double range) {
  if (nominal.std_error > 0) return {.size = kReach * nominal.std_error, .option = {}};
  return {.size = range, .option = nominal.name + "_range"};
}

void add_if_outside(const std::string& laser, const Parameter& found, const Parameter& nominal,
                    const Limit& limit, std::vector<std::string>& caveats) {
  if (limit.size == 0 || std::abs(off_nominal(found, nominal)) <= limit.size) return;
  const data::ShownUnit unit = data::shown_unit(nominal.unit);
  const std::string what =
      limit.option.empty() ? fmt::format("{} standard deviations", kReach) : limit.option;
  const std::string remedy =
      limit.option.empty() ? "or give it a larger sd" : fmt::format("or raise {}", limit.option);
  caveats.push_back(fmt::format(
      "{}.{} is {:.1f} {}, not within {} ({:.1f} {}) of the rig's nominal {:.1f} {}: the calibration is probably in a wrong local minimum. Check the rig's mount, direction and nominal values, {} if {} may be as far off",
      laser, nominal.name, found.value * unit.factor, unit.name, what, limit.size * unit.factor, unit.name,
      nominal.value * unit.factor, unit.name, remedy, nominal.name));
}

/// Pairs of lasers each of which has the other's nominal τ and not its own. In a wrong local minimum, τ alone
/// shows that they are exchanged.
std::vector<std::string> exchanged_by_tau(const Calibration& found, const Rig& rig,
                                          const estimate::ParameterPrior& range) {
  const auto has_tau_of = [&](std::size_t laser, std::size_t other) {
    const Parameter& nominal = rig.lasers[other].nominal.tau;
    return std::abs(found.lasers[laser].tau.value - nominal.value) <= limit_of(nominal, range.tau).size;
  };
  std::vector<std::string> caveats;
  for (std::size_t j = 1; j < found.lasers.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (has_tau_of(i, i) || has_tau_of(j, j) || !has_tau_of(i, j) || !has_tau_of(j, i)) continue;
      const double mm = data::shown_unit("m").factor;
      caveats.push_back(fmt::format(
          "{0}.tau is {1:.1f} mm and {2}.tau is {3:.1f} mm, but the rig's nominal values are {4:.1f} mm and {5:.1f} mm: {0} and {2} are probably exchanged. Exchange their addresses in the rig, and calibrate again",
          found.lasers[i].name, found.lasers[i].tau.value * mm, found.lasers[j].name,
          found.lasers[j].tau.value * mm, rig.lasers[i].nominal.tau.value * mm,
          rig.lasers[j].nominal.tau.value * mm));
    }
  }
  return caveats;
}

/// λ without a standard deviation, which is searched around the whole circle.
bool is_elsewhere(const Parameter& found, const Parameter& nominal) {
  constexpr double kFar = 45 * data::kDegree;  // three standard deviations of a rough value
  return nominal.std_error == 0 && std::abs(off_nominal(found, nominal)) >= kFar + kReach * found.std_error;
}

std::string elsewhere(const LaserCalibration& found, const Parameter& nominal) {
  return fmt::format(
      "{}.lambda is {:.1f} deg, {:.0f} deg from the rig's nominal {:.1f} deg: a laser has another's address, a nominal lambda is wrong, or the calibration is in a wrong local minimum. Check the addresses and each lambda in the rig, or give lambda an sd",
      found.name, found.lambda.value / data::kDegree,
      std::abs(off_nominal(found.lambda, nominal)) / data::kDegree, nominal.value / data::kDegree);
}

/// The limit where the rig has a standard deviation; else the range, which a start outside of it widens.
Limit limit_from(const Parameter& start, const Parameter& nominal, double range) {
  Limit limit = limit_of(nominal, range);
  const double of_start = std::abs(off_nominal(start, nominal));
  if (!limit.option.empty() && of_start > range) limit.size += of_start;
  return limit;
}

/// Each parameter that is farther from its nominal value than the rig or the search allows.
///
/// @param start  values that may be outside as well, since a stage before has reported it: as far as they
///               are, none is reported again, where the rig has no standard deviation
std::vector<std::string> outside(const Calibration& found, const Calibration& start, const Rig& rig,
                                 const estimate::ParameterPrior& range) {
  std::vector<std::string> caveats = exchanged_by_tau(found, rig, range);
  for (std::size_t k = 0; k < found.lasers.size(); ++k) {
    const LaserCalibration& laser = found.lasers[k];
    const LaserCalibration& before = start.lasers[k];
    const LaserCalibration& nominal = rig.lasers[k].nominal;
    const auto add = [&](const Parameter& value, const Parameter& expected, const Limit& limit) {
      add_if_outside(laser.name, value, expected, limit, caveats);
    };
    if (laser.lambda.free) {
      add(laser.lambda, nominal.lambda, limit_of(nominal.lambda, 0));
      const bool is_new = !is_elsewhere(before.lambda, nominal.lambda);
      if (is_new && is_elsewhere(laser.lambda, nominal.lambda))
        caveats.push_back(elsewhere(laser, nominal.lambda));
    }
    add(laser.tau, nominal.tau, limit_from(before.tau, nominal.tau, range.tau));
    add(laser.alpha, nominal.alpha, limit_from(before.alpha, nominal.alpha, range.alpha));
    if (laser.eta.free) add(laser.eta, nominal.eta, limit_of(nominal.eta, 0));
  }
  return caveats;
}

}  // namespace

const std::string_view kDirectionIsOpen =
    "the encoder's sense of rotation is undetermined, since the mirror image agrees with the rig's nominal values as well: the cloud may be the mirror image of the scene. Set plate.direction in the rig";

Calibration mirrored(const Calibration& calibration) {
  Calibration result = calibration;
  const auto reference = std::ranges::find_if(
      calibration.lasers, [](const LaserCalibration& laser) { return !laser.lambda.free; });
  const double kept = reference != calibration.lasers.end() ? reference->lambda.value : 0;
  for (LaserCalibration& laser : result.lasers) {
    laser.lambda.value = kept + std::remainder(kept - laser.lambda.value, kFullTurn);
    laser.tau.value = -laser.tau.value;
    laser.alpha.value = -laser.alpha.value;
  }
  const std::size_t m = result.covariance_order.size();
  const auto keeps_sign = [&](std::size_t k) { return result.covariance_order[k].ends_with(".eta"); };
  for (std::size_t row = 0; row < m; ++row) {
    for (std::size_t column = 0; column < m; ++column) {
      if (keeps_sign(row) != keeps_sign(column)) result.covariance[row * m + column] *= -1;
    }
  }
  const bool is_clockwise = calibration.direction == CountDirection::clockwise;
  result.direction = is_clockwise ? CountDirection::counter_clockwise : CountDirection::clockwise;
  return result;
}

Calibration match_form_of_rig(Calibration calibration, const Rig& rig) {
  double as_it_is = 0;
  double turned = 0;
  for (std::size_t k = 0; k < rig.lasers.size(); ++k) {
    const double tau = calibration.lasers[k].tau.value;
    as_it_is += std::abs(tau - rig.lasers[k].nominal.tau.value);
    turned += std::abs(-tau - rig.lasers[k].nominal.tau.value);
  }
  if (as_it_is <= turned) return calibration;
  for (std::size_t k = 0; k < rig.lasers.size(); ++k) {
    LaserCalibration& laser = calibration.lasers[k];
    const double nominal = rig.lasers[k].nominal.alpha.value;
    laser.tau.value = -laser.tau.value;
    laser.alpha.value = nominal + std::remainder(laser.alpha.value + kFullTurn / 2 - nominal, kFullTurn);
  }
  const std::size_t m = calibration.covariance_order.size();
  const auto changes_sign = [&](std::size_t k) { return calibration.covariance_order[k].ends_with(".tau"); };
  for (std::size_t row = 0; row < m; ++row) {
    for (std::size_t column = 0; column < m; ++column) {
      if (changes_sign(row) != changes_sign(column)) calibration.covariance[row * m + column] *= -1;
    }
  }
  return calibration;
}

std::vector<std::string> known_from_rig_only(const Calibration& calibration,
                                             const estimate::ParameterPrior& prior) {
  constexpr double kAboutAll = 0.9;
  std::vector<std::string> names;
  data::for_each_parameter(calibration, [&](const std::string& name, const Parameter& parameter) {
    const auto known = prior.nominal.find(name);
    if (known != prior.nominal.end() && parameter.free &&
        parameter.std_error > kAboutAll * known->second.std_error) {
      names.push_back(name);
    }
  });
  return names;
}

std::vector<std::string> new_contradictions(const Calibration& calibration, const Calibration& start,
                                            const Rig& rig) {
  const estimate::ParameterPrior range;
  const RigCheck check = check_with_rig(calibration, rig, range);
  return check.is_explained ? check.caveats : outside(calibration, start, rig, range);
}

RigCheck check_with_rig(const Calibration& calibration, const Rig& rig,
                        const estimate::ParameterPrior& range) {
  constexpr double kClearly = 12;  // a likelihood ratio of 400
  constexpr double kFits = 12;     // three values of a laser, each within two standard deviations
  const double as_it_is = distance_from_nominal(calibration, nominal_calibration(rig), range).sum;
  const auto all = rig_mistakes(calibration, rig, range);
  const RigMistake& mirror_image = all.front();
  const RigMistake& nearest = *std::ranges::min_element(all, {}, &RigMistake::sum);
  // A lone laser that is upside down makes the mirror image. Where the rig leaves the direction open, it is
  // that.
  const bool may_be_mirrored =
      rig.plate.direction == CountDirection::automatic && mirror_image.sum() < nearest.sum() + kClearly;
  const RigMistake& best = may_be_mirrored ? mirror_image : nearest;
  const auto fits = [](const RigMistake& one) { return one.distance.largest < kFits; };
  const bool is_explained = fits(best) && best.sum() + kClearly < as_it_is;
  RigCheck check{.is_mirrored = is_explained && &best == &mirror_image,
                 .is_explained = is_explained,
                 .knows_direction = as_it_is + kClearly < mirror_image.sum()};
  if (!is_explained) {
    check.caveats = outside(calibration, nominal_calibration(rig), rig, range);
    return check;
  }
  std::vector<RigMistake> alternatives = {best};
  for (const RigMistake& other : all) {
    const bool is_other = &other != &best && !may_be_mirrored;
    if (is_other && fits(other) && other.sum() < best.sum() + kClearly) alternatives.push_back(other);
  }
  std::ranges::stable_sort(alternatives, {}, &RigMistake::sum);
  check.caveats = {caveat_of(alternatives)};
  return check;
}

std::optional<Calibration> in_direction_of_rig(const Calibration& calibration, const Rig& rig,
                                               const RigCheck& check) {
  if (rig.plate.direction != CountDirection::automatic || !check.is_mirrored) return std::nullopt;
  Calibration turned = match_form_of_rig(estimate::with_angles_near(mirrored(calibration), rig), rig);
  turned.provenance[kDirectionSource] = kFromRecording;
  return turned;
}

bool leaves_direction_open(const Rig& rig, const RigCheck& check) {
  return rig.plate.direction == CountDirection::automatic && !check.knows_direction && !check.is_explained;
}

void note_direction(Calibration& calibration, const Rig& rig, const RigCheck& check) {
  calibration.provenance.erase(kDirectionSource);
  if (check.knows_direction)
    calibration.provenance[kDirectionSource] = kFromRecording;
  else if (!check.is_explained && !leaves_direction_open(rig, check))
    calibration.provenance[kDirectionSource] = kFromRig;
}

}  // namespace crisp::calibrate
