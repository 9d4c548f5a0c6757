// SPDX-License-Identifier: BSD-3-Clause
// The options of stages that simulate, declared once for all of them. `way` leads from the stage to what the
// options are of: a pointer to a member of the stage, or anything else that can be invoked with it.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crisp/stage.hpp>

#include "grabbers/simulate/real_devices.hpp"
#include "grabbers/simulate/scenario.hpp"
#include "grabbers/simulate/settings.hpp"

namespace crisp::simulate {

/// @param way  to a SceneChoice
template <class S, class Way>
void describe_scene(StageDescription<S>& d, Way way) {
  d.option("scene", way, &SceneChoice::name, "scene around the scanner; paper: the room of the paper")
      .choices({"office", "hall", "street", "workshop", "garden", "people", "paper"});
  d.option("scene_file", way, &SceneChoice::file, "scene file in YAML, instead of `scene`");
}

/// @param way  to a RealismChoice
template <class S, class Way>
void describe_realism(StageDescription<S>& d, Way way) {
  d.option(
      "devices", way, &RealismChoice::devices,
      "real devices whose measured noise, mirrors and clocks the simulated ones have: `lms111` (every laser), `laser2=tim781s`, `plate=esp32_wifi`; known are " +
          fmt::format("{}", fmt::join(real_devices(), ", ")));
  d.option(
      "findings", way, &RealismChoice::findings_file,
      "a diagnosis.json: its accepted findings apply to the simulated scanner, with each device's measured noise, clock, delays and mirror");
}

/// @param way  to a TruthChoice
template <class S, class Way>
void describe_truth(StageDescription<S>& d, Way way) {
  d.option("calibration", way, &TruthChoice::calibration_file,
           "true calibration; by default it is drawn around nominal");
  d.group("nominal_errors", "largest departures of the drawn truth from nominal, without a `calibration`");
  const auto off = &TruthChoice::nominal_errors;
  d.option("nominal_errors.tau", way, off, &NominalErrors::tau, "largest departure of τ")
      .unit("m")
      .range(0, 1);
  d.option("nominal_errors.alpha", way, off, &NominalErrors::alpha, "largest departure of α")
      .unit("rad")
      .range(0, 3.2);
  d.option("nominal_errors.lambda", way, off, &NominalErrors::lambda,
           "largest departure of λ; the first laser's is the gauge and stays")
      .unit("rad")
      .range(0, 3.2);
  d.option("nominal_errors.eta", way, off, &NominalErrors::eta, "largest departure of η")
      .unit("s")
      .range(0, 1);
  d.option(
      "effects", way, &TruthChoice::effects,
      "effects of the simulated scanner: `{encoder.eccentricity: {a: 0.1deg}, laser2.mirror.cone: {kappa: 0.3deg}}`, named as in `crisp effects`; without an owner an effect applies to all that can have it");
}

/// @param way  to a MotionSettings
template <class S, class Way>
void describe_motion(StageDescription<S>& d, Way way) {
  d.group("motion", "how the plate turns");
  d.option("motion.kind", way, &MotionSettings::kind, "course of its rate")
      .choices({{"constant", MotionKind::constant},
                {"varying", MotionKind::varying},
                {"reversal", MotionKind::reversal},
                {"stop_and_go", MotionKind::stop_and_go}});
  d.option("motion.min_rate", way, &MotionSettings::min_rate, "lowest rate of a varying motion")
      .unit("Hz")
      .range(-50, 50);
  d.option("motion.max_rate", way, &MotionSettings::max_rate, "highest rate, or the constant rate")
      .unit("Hz")
      .range(-50, 50);
  d.option("motion.change_time", way, &MotionSettings::change_time, "duration of a change of the rate")
      .unit("s")
      .range(0.01, 1e4);
  d.option("motion.hold_time", way, &MotionSettings::hold_time,
           "duration for which reversal and stop_and_go hold a rate")
      .unit("s")
      .range(0, 1e4);
}

/// Those of the group that describe_field() declares.
///
/// @param way  to a KindChoice
template <class S, class Way>
void describe_kinds(StageDescription<S>& d, Way way) {
  d.option(
      "lasers.kinds", way, &KindChoice::lasers,
      "lasers of another kind: `{laser2: {first_angle: -5deg, last_angle: 185deg, step: 0.25deg, mirror_frequency: 25Hz}}`; missing keys are as for all");
}

/// @param way  to a ScannerSettings
template <class S, class Way>
void describe_field(StageDescription<S>& d, Way way) {
  d.group("lasers", "the lasers: ranges, field of view and mirror");
  const auto field = &ScannerSettings::field;
  const auto mirror = &ScannerSettings::mirror;
  d.option("lasers.max_range", way, &ScannerSettings::range, &RangeSettings::max_distance,
           "largest range with an echo")
      .unit("m")
      .range(0.1, 65);
  d.option("lasers.first_angle", way, field, &FieldOfView::first, "reported angle of the first beam")
      .unit("rad");
  d.option("lasers.last_angle", way, field, &FieldOfView::last, "reported angle of the last beam")
      .unit("rad");
  d.option("lasers.step", way, field, &FieldOfView::step, "angle between beams").unit("rad").range(1e-4, 1);
  d.option("lasers.mirror_frequency", way, mirror, &MirrorSettings::frequency, "nominal rate of the mirrors")
      .unit("Hz")
      .range(1, 1000);
  d.option("lasers.mirror_slowest", way, mirror, &MirrorSettings::slowest,
           "largest excess of a mirror's mean period over nominal, which is drawn")
      .unit("1")
      .range(0, 0.1);
  d.option("lasers.mirror_wander", way, mirror, &MirrorSettings::wander,
           "largest slow deviation of the period")
      .unit("1")
      .range(0, 0.1);
  d.option("lasers.mirror_jitter", way, mirror, &MirrorSettings::jitter,
           "standard deviation of each single period")
      .unit("1")
      .range(0, 0.01);
}

}  // namespace crisp::simulate
