// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/each_parameter.hpp"
#include "pipeline/data/shown_unit.hpp"

namespace crisp {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kReach = 3;  // standard deviations of a nominal value that a parameter may be off

/// Standard deviations of one laser's nominal values: the rig's, or else half of a range. Nominal values of λ
/// are not needed by the search, so that they may be rough.
struct NominalErrors {
  NominalErrors(const LaserCalibration& nominal, const ParameterPrior& range)
      : lambda(nominal.lambda.std_error > 0 ? nominal.lambda.std_error : 15 * kDegree),
        tau(nominal.tau.std_error > 0 ? nominal.tau.std_error : range.tau / 2),
        alpha(nominal.alpha.std_error > 0 ? nominal.alpha.std_error : range.alpha / 2) {}
  double lambda, tau, alpha;
};

double wrapped(double angle) { return std::remainder(angle, 2 * kPi); }

double square(double x) { return x * x; }

/// Squared distance of one laser from its nominal values, in their standard deviations.
///
/// @param turn  [rad] by which the calibration's frame is turned against the rig's
double distance(const LaserCalibration& found, const LaserCalibration& nominal, double turn,
                const ParameterPrior& range) {
  const NominalErrors error(nominal, range);
  const auto at = [&](double lambda, double tau, double alpha) {
    return square(wrapped(lambda - nominal.lambda.value - turn) / error.lambda) +
           square((tau - nominal.tau.value) / error.tau) +
           square(wrapped(alpha - nominal.alpha.value) / error.alpha);
  };
  const double lambda = found.lambda.value, tau = found.tau.value, alpha = found.alpha.value;
  return std::min(at(lambda, tau, alpha), at(lambda + kPi, -tau, alpha + kPi));  // both place beams alike
}

/// Squared distance of all lasers, in the frame in which it is smallest.
double distance(const Calibration& found, const Calibration& nominal, const ParameterPrior& range) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t reference = 0; reference < found.lasers.size(); ++reference) {
    for (const double half_turn : {0.0, kPi}) {
      const double turn =
          found.lasers[reference].lambda.value - nominal.lasers[reference].lambda.value + half_turn;
      double sum = 0;
      for (std::size_t k = 0; k < found.lasers.size(); ++k) {
        sum += distance(found.lasers[k], nominal.lasers[k], turn, range);
      }
      least = std::min(least, sum);
    }
  }
  return least;
}

/// A possible mistake of a rig, with the calibration's distance from nominal values under it.
struct Hypothesis {
  std::string statement;
  std::string remedy;
  double distance = 0;
  bool is_exchange = false;  ///< of lasers: whichever was exchanged, the scene keeps its sense
};

Hypothesis other_direction(const Calibration& calibration, double distance) {
  const bool is_clockwise = calibration.direction == CountDirection::clockwise;
  const char* states = is_clockwise ? "clockwise" : "counter-clockwise";
  const char* counts = is_clockwise ? "counter-clockwise" : "clockwise";
  return {
      .statement = fmt::format(
          "the encoder counts {}, not {}, by the signs of tau and alpha and the order of the lasers: the cloud is the mirror image of the scene",
          counts, states),
      .remedy =
          fmt::format("Set plate.direction: {} in the rig", is_clockwise ? "counter_clockwise" : "clockwise"),
      .distance = distance};
}

/// What is wrong in the rig, and what to change. Several hypotheses, the nearest first: the nominal values do
/// not decide between them.
std::string caveat_of(const std::vector<Hypothesis>& alternatives) {
  if (alternatives.size() == 1) return alternatives[0].statement + ". " + alternatives[0].remedy;
  std::string caveat = fmt::format(
      "{} corrections of the rig fit, the likeliest first, and the recording cannot decide between them",
      alternatives.size());
  for (std::size_t k = 0; k < alternatives.size(); ++k)
    caveat += fmt::format("; {}) {}. {}", k + 1, alternatives[k].statement, alternatives[k].remedy);
  const bool is_exchange = std::ranges::all_of(alternatives, &Hypothesis::is_exchange);
  return caveat +
         (is_exchange
              ? ". Find out on the scanner which one is true"
              : ". Find out on the scanner which one is true: a wrong correction gives a mirror image of the scene");
}

std::vector<Hypothesis> hypotheses(const Calibration& found, const Rig& rig, const ParameterPrior& range) {
  const Calibration nominal = nominal_calibration(rig);
  std::vector<Hypothesis> all = {other_direction(found, distance(mirrored(found), nominal, range))};
  Calibration all_turned = nominal;
  for (LaserCalibration& laser : all_turned.lasers) laser.alpha.value += kPi;
  if (nominal.lasers.size() > 1) {
    all.push_back(
        {"all lasers are mounted upside down, or their mounts are off by 180 degrees, compared with the rig",
         "Turn each mount, or each nominal alpha, by 180 degrees in the rig",
         distance(found, all_turned, range)});
  }
  for (std::size_t i = 0; i < nominal.lasers.size(); ++i) {
    const std::string& name = nominal.lasers[i].name;
    Calibration turned = nominal;
    turned.lasers[i].alpha.value += kPi;
    all.push_back(
        {fmt::format("{} is mounted upside down, or its mount is off by 180 degrees, compared with the rig",
                     name),
         fmt::format("Turn {}'s mount, or its nominal alpha, by 180 degrees in the rig", name),
         distance(found, turned, range)});
    for (std::size_t j = 0; j < i; ++j) {
      Calibration exchanged = nominal;
      std::swap(exchanged.lasers[i], exchanged.lasers[j]);
      all.push_back({fmt::format("{} and {} are exchanged: each has the other's nominal values",
                                 nominal.lasers[j].name, name),
                     "Exchange their addresses in the rig", distance(found, exchanged, range), true});
    }
  }
  return all;
}

/// Largest distance of a parameter from its nominal value, with its description.
struct Limit {
  double size = 0;     ///< 0: as far as it likes
  std::string option;  ///< of calibrate.rqe, if the rig gives no standard deviation
};

Limit limit_of(const Parameter& nominal, double range) {
  if (nominal.std_error > 0) return {.size = kReach * nominal.std_error, .option = {}};
  return {.size = range, .option = nominal.name + "_range"};
}

void add_if_outside(const std::string& laser, const Parameter& found, const Parameter& nominal,
                    const Limit& limit, std::vector<std::string>& caveats) {
  const bool is_angle = nominal.unit == "rad";
  const double off = is_angle ? wrapped(found.value - nominal.value) : found.value - nominal.value;
  if (limit.size == 0 || std::abs(off) <= limit.size) return;
  const ShownUnit unit = shown_unit(nominal.unit);
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
                                          const ParameterPrior& range) {
  const auto has_tau_of = [&](std::size_t laser, std::size_t other) {
    const Parameter& nominal = rig.lasers[other].nominal.tau;
    return std::abs(found.lasers[laser].tau.value - nominal.value) <= limit_of(nominal, range.tau).size;
  };
  std::vector<std::string> caveats;
  for (std::size_t j = 1; j < found.lasers.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (has_tau_of(i, i) || has_tau_of(j, j) || !has_tau_of(i, j) || !has_tau_of(j, i)) continue;
      const double mm = shown_unit("m").factor;
      caveats.push_back(fmt::format(
          "{0}.tau is {1:.1f} mm and {2}.tau is {3:.1f} mm, but the rig's nominal values are {4:.1f} mm and {5:.1f} mm: {0} and {2} are probably exchanged. Exchange their addresses in the rig, and calibrate again",
          found.lasers[i].name, found.lasers[i].tau.value * mm, found.lasers[j].name,
          found.lasers[j].tau.value * mm, rig.lasers[i].nominal.tau.value * mm,
          rig.lasers[j].nominal.tau.value * mm));
    }
  }
  return caveats;
}

/// Each parameter that is farther from its nominal value than the rig or the search allows.
std::vector<std::string> outside(const Calibration& found, const Rig& rig, const ParameterPrior& range) {
  std::vector<std::string> caveats = exchanged_by_tau(found, rig, range);
  for (std::size_t k = 0; k < found.lasers.size(); ++k) {
    const LaserCalibration& laser = found.lasers[k];
    const LaserCalibration& nominal = rig.lasers[k].nominal;
    const auto add = [&](const Parameter& value, const Parameter& expected, const Limit& limit) {
      add_if_outside(laser.name, value, expected, limit, caveats);
    };
    if (laser.lambda.free) add(laser.lambda, nominal.lambda, limit_of(nominal.lambda, 0));
    add(laser.tau, nominal.tau, limit_of(nominal.tau, range.tau));
    add(laser.alpha, nominal.alpha, limit_of(nominal.alpha, range.alpha));
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
    laser.lambda.value = kept + wrapped(kept - laser.lambda.value);
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
    laser.alpha.value = nominal + wrapped(laser.alpha.value + kPi - nominal);
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

std::vector<std::string> known_from_rig_only(const Calibration& calibration, const ParameterPrior& prior) {
  constexpr double kAboutAll = 0.9;
  std::vector<std::string> names;
  for_each_parameter(calibration, [&](const std::string& name, const Parameter& parameter) {
    const auto known = prior.nominal.find(name);
    if (known != prior.nominal.end() && parameter.free &&
        parameter.std_error > kAboutAll * known->second.std_error) {
      names.push_back(name);
    }
  });
  return names;
}

std::vector<std::string> far_from_nominal(const Calibration& calibration, const Rig& rig) {
  return outside(calibration, rig, {.tau = 0, .alpha = 0});
}

RigCheck check_with_rig(const Calibration& calibration, const Rig& rig, const ParameterPrior& range) {
  constexpr double kClearly = 12;       // a likelihood ratio of 400
  constexpr double kFitsPerLaser = 12;  // three values, each within two standard deviations
  const double as_it_is = distance(calibration, nominal_calibration(rig), range);
  const auto all = hypotheses(calibration, rig, range);
  const Hypothesis& mirror_image = all.front();
  const Hypothesis& nearest = *std::ranges::min_element(all, {}, &Hypothesis::distance);
  // A lone laser that is upside down makes the mirror image. Where the rig leaves the direction open, it is
  // that.
  const bool may_be_mirrored =
      rig.plate.direction == CountDirection::automatic && mirror_image.distance < nearest.distance + kClearly;
  const Hypothesis& best = may_be_mirrored ? mirror_image : nearest;
  const bool fits = best.distance < kFitsPerLaser * static_cast<double>(rig.lasers.size());
  const bool is_explained = fits && best.distance + kClearly < as_it_is;
  RigCheck check{.is_mirrored = is_explained && &best == &mirror_image,
                 .is_explained = is_explained,
                 .knows_direction = as_it_is + kClearly < mirror_image.distance};
  if (!is_explained) {
    check.caveats = outside(calibration, rig, range);
    return check;
  }
  std::vector<Hypothesis> alternatives = {best};
  for (const Hypothesis& other : all) {
    const bool is_other = &other != &best && !may_be_mirrored;
    if (is_other && other.distance < best.distance + kClearly) alternatives.push_back(other);
  }
  std::ranges::stable_sort(alternatives, {}, &Hypothesis::distance);
  check.caveats = {caveat_of(alternatives)};
  return check;
}

std::optional<Calibration> in_direction_of_rig(const Calibration& calibration, const Rig& rig,
                                               const RigCheck& check) {
  if (rig.plate.direction != CountDirection::automatic || !check.is_mirrored) return std::nullopt;
  Calibration turned = match_form_of_rig(with_angles_near(mirrored(calibration), rig), rig);
  turned.provenance[kDirectionSource] = kFromRecording;
  return turned;
}

void note_direction(Calibration& calibration, const RigCheck& check) {
  calibration.provenance.erase(kDirectionSource);
  if (check.knows_direction)
    calibration.provenance[kDirectionSource] = kFromRecording;
  else if (!check.is_explained)
    calibration.provenance[kDirectionSource] = kFromRig;
}

}  // namespace crisp
