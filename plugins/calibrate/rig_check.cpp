// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/rig_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLambdaError =
    15 * kDegree;  // standard deviation of a nominal λ: the search does not need it

double wrapped(double angle) { return std::remainder(angle, 2 * kPi); }

double square(double x) { return x * x; }

/// Squared distance of one laser from its nominal values, in their standard deviations.
///
/// @param turn  [rad] by which the calibration's frame is turned against the rig's
double distance(const LaserCalibration& found, const LaserCalibration& nominal, double turn,
                const SearchRange& range) {
  const auto at = [&](double lambda, double tau, double alpha) {  // half of a range is one standard deviation
    return square(wrapped(lambda - nominal.lambda.value - turn) / kLambdaError) +
           square(2 * (tau - nominal.tau.value) / range.tau) +
           square(2 * wrapped(alpha - nominal.alpha.value) / range.alpha);
  };
  const double lambda = found.lambda.value, tau = found.tau.value, alpha = found.alpha.value;
  return std::min(at(lambda, tau, alpha), at(lambda + kPi, -tau, alpha + kPi));  // both place beams alike
}

/// Squared distance of all lasers, in the frame in which it is smallest.
double distance(const Calibration& found, const Calibration& nominal, const SearchRange& range) {
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

/// What may be wrong in a rig, and how far the calibration is from nominal values then.
struct Hypothesis {
  std::string caveat;
  double distance = 0;
};

std::string other_direction(const Calibration& calibration) {
  const bool is_clockwise = calibration.direction == CountDirection::clockwise;
  const char* says = is_clockwise ? "clockwise" : "counter-clockwise";
  const char* counts = is_clockwise ? "counter-clockwise" : "clockwise";
  return fmt::format(
      "the encoder counts {}, not {}, by the signs of tau and alpha and the order of the lasers: the cloud "
      "is the mirror "
      "image of the scene. Set plate.direction: {} in the rig",
      counts, says, is_clockwise ? "counter_clockwise" : "clockwise");
}

std::vector<Hypothesis> hypotheses(const Calibration& found, const Rig& rig, const SearchRange& range) {
  const Calibration nominal = nominal_calibration(rig);
  std::vector<Hypothesis> all = {{other_direction(found), distance(mirrored(found), nominal, range)}};
  Calibration all_turned = nominal;
  for (LaserCalibration& laser : all_turned.lasers) laser.alpha.value += kPi;
  if (nominal.lasers.size() > 1) {
    all.push_back(
        {"all lasers are mounted upside down, or their mounts are off by 180 degrees, against what the rig "
         "says. "
         "Turn each mount, or each nominal alpha, by 180 degrees in the rig",
         distance(found, all_turned, range)});
  }
  for (std::size_t i = 0; i < nominal.lasers.size(); ++i) {
    const std::string& name = nominal.lasers[i].name;
    Calibration turned = nominal;
    turned.lasers[i].alpha.value += kPi;
    all.push_back(
        {fmt::format(
             "{0} is mounted upside down, or its mount is off by 180 degrees, against what the rig says. "
             "Turn {0}'s mount, or its nominal alpha, by 180 degrees in the rig",
             name),
         distance(found, turned, range)});
    for (std::size_t j = 0; j < i; ++j) {
      Calibration exchanged = nominal;
      std::swap(exchanged.lasers[i], exchanged.lasers[j]);
      all.push_back({fmt::format("{} and {} are exchanged: each was found where the rig has the other. "
                                 "Exchange their addresses "
                                 "in the rig, or their cables",
                                 nominal.lasers[j].name, name),
                     distance(found, exchanged, range)});
    }
  }
  return all;
}

/// Each τ and α that is outside of its range.
std::vector<std::string> outside(const Calibration& found, const Rig& rig, const SearchRange& range) {
  std::vector<std::string> caveats;
  for (std::size_t k = 0; k < found.lasers.size(); ++k) {
    const LaserCalibration& laser = found.lasers[k];
    const LaserCalibration& nominal = rig.lasers[k].nominal;
    if (std::abs(laser.tau.value - nominal.tau.value) > range.tau) {
      caveats.push_back(fmt::format(
          "{}.tau is {:.0f} mm, more than tau_range ({:.0f} mm) from the rig's nominal {:.0f} mm: the "
          "calibration is probably in a wrong local minimum. Check the rig's mount, direction and tau, "
          "or raise tau_range if tau may be as far off",
          laser.name, laser.tau.value * 1e3, range.tau * 1e3, nominal.tau.value * 1e3));
    }
    if (std::abs(wrapped(laser.alpha.value - nominal.alpha.value)) > range.alpha) {
      caveats.push_back(fmt::format(
          "{}.alpha is {:.1f} degrees, more than alpha_range ({:.1f} degrees) from the rig's nominal "
          "{:.1f}: the calibration is probably in a wrong local minimum. Check the rig's mount, direction "
          "and alpha, or raise alpha_range if alpha may be as far off",
          laser.name, laser.alpha.value / kDegree, range.alpha / kDegree, nominal.alpha.value / kDegree));
    }
  }
  return caveats;
}

}  // namespace

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

RigCheck check_with_rig(const Calibration& calibration, const Rig& rig, const SearchRange& range) {
  constexpr double kClearly = 12;       // a likelihood ratio of 400
  constexpr double kFitsPerLaser = 12;  // three values, each within two standard deviations
  const double as_it_is = distance(calibration, nominal_calibration(rig), range);
  const auto all = hypotheses(calibration, rig, range);
  const Hypothesis& mirror_image = all.front();
  const Hypothesis& best = *std::ranges::min_element(all, {}, &Hypothesis::distance);
  const bool fits = best.distance < kFitsPerLaser * static_cast<double>(rig.lasers.size());
  const bool is_explained = fits && best.distance + kClearly < as_it_is;
  RigCheck check{.is_mirrored = is_explained && &best == &mirror_image,
                 .knows_direction = as_it_is + kClearly < mirror_image.distance};
  check.caveats = is_explained ? std::vector{best.caveat} : outside(calibration, rig, range);
  return check;
}

}  // namespace crisp
