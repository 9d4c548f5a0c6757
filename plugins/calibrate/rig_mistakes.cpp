// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "pipeline/data/degree.hpp"
#include "plugins/calibrate/rig_check.hpp"

namespace crisp::calibrate {
namespace {

constexpr double kPi = std::numbers::pi;

/// Standard deviations of one laser's nominal values: the rig's, or else half of a range. Nominal values of λ
/// are not needed by the search, so that they may be rough.
struct NominalErrors {
  NominalErrors(const LaserCalibration& nominal, const estimate::ParameterPrior& range)
      : lambda(nominal.lambda.std_error > 0 ? nominal.lambda.std_error : 15 * data::kDegree),
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
                const estimate::ParameterPrior& range) {
  const NominalErrors error(nominal, range);
  const auto at = [&](double lambda, double tau, double alpha) {
    return square(wrapped(lambda - nominal.lambda.value - turn) / error.lambda) +
           square((tau - nominal.tau.value) / error.tau) +
           square(wrapped(alpha - nominal.alpha.value) / error.alpha);
  };
  const double lambda = found.lambda.value, tau = found.tau.value, alpha = found.alpha.value;
  return std::min(at(lambda, tau, alpha), at(lambda + kPi, -tau, alpha + kPi));  // both place beams alike
}

RigMistake other_direction(const Calibration& calibration, const RigDistance& distance) {
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

/// Azimuths that were counted the other way: the lasers' order is reversed, but each sits as it should.
RigMistake other_sign_of_lambda(const Calibration& found, Calibration nominal,
                                const estimate::ParameterPrior& range) {
  for (LaserCalibration& laser : nominal.lasers) laser.lambda.value = -laser.lambda.value;
  return {
      .statement = "each lambda has the other sign: the rig counts the lasers' azimuths clockwise",
      .remedy =
          "Change the sign of each nominal lambda in the rig: they count counter-clockwise, seen from above",
      .distance = distance_from_nominal(found, nominal, range),
      .keeps_sense = true};
}

}  // namespace

RigDistance distance_from_nominal(const Calibration& found, const Calibration& nominal,
                                  const estimate::ParameterPrior& range) {
  RigDistance least;
  for (std::size_t reference = 0; reference < found.lasers.size(); ++reference) {
    for (const double half_turn : {0.0, kPi}) {
      const double turn =
          found.lasers[reference].lambda.value - nominal.lasers[reference].lambda.value + half_turn;
      RigDistance all{.sum = 0};
      for (std::size_t k = 0; k < found.lasers.size(); ++k) {
        const double own = distance(found.lasers[k], nominal.lasers[k], turn, range);
        all.sum += own;
        all.largest = std::max(all.largest, own);
      }
      if (all.sum < least.sum) least = all;
    }
  }
  return least;
}

std::vector<RigMistake> rig_mistakes(const Calibration& found, const Rig& rig,
                                     const estimate::ParameterPrior& range) {
  const Calibration nominal = nominal_calibration(rig);
  std::vector<RigMistake> all = {
      other_direction(found, distance_from_nominal(mirrored(found), nominal, range))};
  Calibration all_turned = nominal;
  for (LaserCalibration& laser : all_turned.lasers) laser.alpha.value += kPi;
  if (nominal.lasers.size() > 1) {
    all.push_back(
        {"all lasers are mounted upside down, or their mounts are off by 180 degrees, compared with the rig",
         "Turn each mount, or each nominal alpha, by 180 degrees in the rig",
         distance_from_nominal(found, all_turned, range)});
  }
  for (std::size_t i = 0; i < nominal.lasers.size(); ++i) {
    const std::string& name = nominal.lasers[i].name;
    Calibration turned = nominal;
    turned.lasers[i].alpha.value += kPi;
    all.push_back(
        {fmt::format("{} is mounted upside down, or its mount is off by 180 degrees, compared with the rig",
                     name),
         fmt::format("Turn {}'s mount, or its nominal alpha, by 180 degrees in the rig", name),
         distance_from_nominal(found, turned, range)});
    for (std::size_t j = 0; j < i; ++j) {
      Calibration exchanged = nominal;
      std::swap(exchanged.lasers[i], exchanged.lasers[j]);
      all.push_back({fmt::format("{} and {} are exchanged: each has the other's nominal values",
                                 nominal.lasers[j].name, name),
                     "Exchange their addresses in the rig", distance_from_nominal(found, exchanged, range),
                     true});
    }
  }
  if (nominal.lasers.size() > 1) all.push_back(other_sign_of_lambda(found, nominal, range));
  return all;
}

std::string caveat_of(const std::vector<RigMistake>& alternatives) {
  if (alternatives.size() == 1) return alternatives[0].statement + ". " + alternatives[0].remedy;
  std::string caveat = fmt::format(
      "{} corrections of the rig fit, the likeliest first, and the recording cannot decide between them",
      alternatives.size());
  for (std::size_t k = 0; k < alternatives.size(); ++k)
    caveat += fmt::format("; {}) {}. {}", k + 1, alternatives[k].statement, alternatives[k].remedy);
  const bool keeps_sense = std::ranges::all_of(alternatives, &RigMistake::keeps_sense);
  return caveat +
         (keeps_sense
              ? ". Find out on the scanner which one is true"
              : ". Find out on the scanner which one is true: a wrong correction gives a mirror image of the scene");
}

}  // namespace crisp::calibrate
