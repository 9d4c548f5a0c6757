// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Errors by formulae of the tests, which no term of the catalogue describes.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "tests/plugins/diagnose/noise/drawn.hpp"

namespace crisp::test {

/// Covariates of one beam.
struct BeamFacts {
  double mirror = 0;  ///< [rad] angle of the mirror
  PlateState plate = {};
  double time = 0;       ///< [s]
  double range = 0;      ///< [m]
  double incidence = 0;  ///< [rad]
  double remission = 0;
};

/// Random parameters of an error.
struct ErrorDraw {
  double phase = 0;  ///< [rad] 0 to 2π
  int order = 3;     ///< of harmonics: 3 or 4
};

struct SomethingElse {
  const char* covariate;  ///< on which it depends
  enum class On : std::uint8_t { kRange, kMirrorAngle, kPlateAngle } on = On::kRange;
  double (*shape)(const BeamFacts& beam, const ErrorDraw& draw) = nullptr;  ///< up to a factor
};

inline double bump(double from_middle, double width) { return std::exp(-std::pow(from_middle / width, 2)); }

inline const std::vector<SomethingElse>& something_else() {
  using On = SomethingElse::On;
  using Beam = BeamFacts;
  using Draw = ErrorDraw;
  static const std::vector<SomethingElse> all = {
      {"mirror angle", On::kRange,
       [](const Beam& b, const Draw& d) { return std::sin(d.order * b.mirror + d.phase); }},
      {"plate angle", On::kRange,
       [](const Beam& b, const Draw& d) { return std::sin(d.order * b.plate.angle + d.phase); }},
      {"time", On::kRange,
       [](const Beam& b, const Draw& d) { return std::sin(2 * std::numbers::pi * b.time / 5 + d.phase); }},
      {"range", On::kRange, [](const Beam& b, const Draw&) { return bump(b.range - 3, 0.7); }},
      {"mirror angle", On::kMirrorAngle,
       [](const Beam& b, const Draw& d) { return std::sin(d.order * b.mirror + d.phase); }},
      {"plate angle", On::kPlateAngle,
       [](const Beam& b, const Draw& d) { return std::sin(d.order * b.plate.angle + d.phase); }},
      // Where walls are met at about 45°.
      {"incidence", On::kRange, [](const Beam& b, const Draw&) { return bump(b.incidence - 0.8, 0.25); }},
      {"remission", On::kRange,
       [](const Beam& b, const Draw& d) { return std::sin(b.remission / 15 + d.phase); }},
      {"plate rate", On::kRange,
       [](const Beam& b, const Draw& d) { return std::sin(0.8 * b.plate.rate + d.phase); }},
      // Finer than any shape of the catalogue.
      {"mirror angle", On::kRange,
       [](const Beam& b, const Draw& d) { return std::sin((4 + d.order) * b.mirror + d.phase); }},
      // Dirt on the window.
      {"mirror angle", On::kRange,
       [](const Beam& b, const Draw& d) { return bump((b.mirror - 0.6 * (d.phase - 3)), 0.15); }},
      // A shock.
      {"time", On::kRange, [](const Beam& b, const Draw& d) { return bump(b.time - 1.5 * d.phase, 0.5); }},
      // A nonlinear detector.
      {"range", On::kRange, [](const Beam& b, const Draw&) { return b.range * b.range; }}};
  return all;
}

/// Injects an error into a recording: into the ranges or mirror angles of one laser, or into the plate's
/// angles. Its size [m] is the RMS change of ranges; for angles, at a typical range.
inline Drawn with_something_else(Drawn made, const SomethingElse& error, std::size_t laser,
                                 const ErrorDraw& draw, double size) {
  constexpr double kUsualRange = 3;  // [m]
  const double angle = size * std::numbers::sqrt2 / kUsualRange;
  Measurements& beams = made.recording.made.beams;
  PlateTrajectory& plate = made.recording.made.plate;
  made.covariate = error.covariate;
  if (error.on == SomethingElse::On::kPlateAngle) {
    std::vector<double> times;
    std::vector<double> angles;
    constexpr double kStep = 0.002;  // [s]
    for (double t = beams.time.front() - 0.2; t < beams.time.back() + 0.2; t += kStep) {
      const auto state = plate.at(t);
      if (!state) continue;
      times.push_back(t);
      angles.push_back(state->angle + angle * error.shape({.plate = *state}, draw));
    }
    plate = PlateTrajectory(beams.epoch_ns, times, angles, 0.1);
    return made;
  }
  std::vector<double> errors(beams.size(), 0);
  double squares = 0;
  double count = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] != laser) continue;
    errors[i] = error.shape({.mirror = double{beams.mirror_angle[i]},
                             .plate = plate.at(beams.time[i]).value_or(PlateState{}),
                             .time = beams.time[i],
                             .range = double{beams.range[i]},
                             .incidence = std::acos(double{made.recording.made.cos_incidence[i]}),
                             .remission = double{beams.remission[i]}},
                            draw);
    squares += errors[i] * errors[i];
    count += 1;
  }
  const double scale = size / std::sqrt(squares / count);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (error.on == SomethingElse::On::kMirrorAngle) {
      beams.mirror_angle[i] += static_cast<float>(angle * errors[i]);
    } else {
      beams.range[i] += static_cast<float>(scale * errors[i]);
    }
  }
  return made;
}

inline Drawn Drawer::with_something_else(std::size_t which, double size) {
  const std::size_t laser = below(scanner().rig.lasers.size());
  const double phase = uniform(0, 2 * std::numbers::pi);
  const int order = 3 + static_cast<int>(below(2));
  return test::with_something_else(record(), something_else().at(which), laser,
                                   {.phase = phase, .order = order}, size);
}

}  // namespace crisp::test
