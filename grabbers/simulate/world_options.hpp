// SPDX-License-Identifier: BSD-3-Clause
// The options of stages that simulate, declared once for all of them. `way` leads from the stage to what the
// options are of: a pointer to a member of the stage, or anything else that can be invoked with it.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "grabbers/simulate/real_devices.hpp"
#include "grabbers/simulate/settings.hpp"
#include "grabbers/simulate/world.hpp"
#include "pipeline/stage/description.hpp"

namespace crisp {

/// @param way  to a SceneChoice
template <class S, class Way>
void describe_scene(StageDescription<S>& d, Way way) {
  d.option("scene", way, &SceneChoice::name, "what stands around the scanner; paper: the room of the paper")
      .choices({"office", "hall", "street", "workshop", "garden", "people", "paper"});
  d.option("scene_file", way, &SceneChoice::file, "a scene of your own in YAML, in place of `scene`");
}

/// @param way  to a LikenessChoice
template <class S, class Way>
void describe_likeness(StageDescription<S>& d, Way way) {
  d.option("devices", way, &LikenessChoice::devices,
           "real devices that the simulated ones scatter, turn and keep time like, as they were measured: "
           "`lms111` (every "
           "laser), `laser2=tim781s`, `plate=esp32_wifi`; known are " +
               fmt::format("{}", fmt::join(real_devices(), ", ")));
  d.option("findings", way, &LikenessChoice::findings_file,
           "a diagnosis.json: what was found and accepted befalls the simulated scanner, and each device has "
           "the noise, clock, delays and mirror that were measured");
}

/// @param way  to a TruthChoice
template <class S, class Way>
void describe_truth(StageDescription<S>& d, Way way) {
  d.option("calibration", way, &TruthChoice::calibration_file,
           "the true calibration; without one it is drawn around nominal");
  const auto off = &TruthChoice::departures;
  d.option("tau_off", way, off, &Departures::tau, "largest departure of a drawn τ from nominal")
      .unit("m")
      .range(0, 1);
  d.option("alpha_off", way, off, &Departures::alpha, "largest departure of a drawn α from nominal")
      .unit("rad")
      .range(0, 3.2);
  d.option("lambda_off", way, off, &Departures::lambda,
           "largest departure of a drawn λ from nominal; the first laser's is the gauge and stays")
      .unit("rad")
      .range(0, 3.2);
  d.option("eta_off", way, off, &Departures::eta, "largest departure of a drawn η from nominal")
      .unit("s")
      .range(0, 1);
  d.option(
      "effects", way, &TruthChoice::effects,
      "what departs from a plain scanner: `{encoder.eccentricity: {a: 0.1deg}, laser2.mirror.cone: {kappa: "
      "0.3deg}}`, by the names that `crisp effects` lists; without an owner it befalls all that can have it");
}

/// @param way  to a MotionSettings
template <class S, class Way>
void describe_motion(StageDescription<S>& d, Way way) {
  d.option("motion", way, &MotionSettings::kind, "how the plate turns")
      .choices({{"constant", MotionKind::constant},
                {"varying", MotionKind::varying},
                {"reversal", MotionKind::reversal},
                {"stop_and_go", MotionKind::stop_and_go}});
  d.option("min_rate", way, &MotionSettings::min_rate, "slowest rate of a varying motion")
      .unit("Hz")
      .range(-50, 50);
  d.option("max_rate", way, &MotionSettings::max_rate, "fastest rate, or the only one")
      .unit("Hz")
      .range(-50, 50);
  d.option("change_time", way, &MotionSettings::change_time, "how long a change of the rate takes")
      .unit("s")
      .range(0.01, 1e4);
  d.option("hold_time", way, &MotionSettings::hold_time, "how long reversal and stop_and_go hold a rate")
      .unit("s")
      .range(0, 1e4);
}

/// @param way  to a KindChoice
template <class S, class Way>
void describe_kinds(StageDescription<S>& d, Way way) {
  d.option("lasers", way, &KindChoice::lasers,
           "lasers of another kind: `{laser2: {first_angle: -5deg, last_angle: 185deg, step: 0.25deg, "
           "mirror_frequency: 25Hz}}`; what is not given is as for all");
}

/// @param way  to a ScannerSettings
template <class S, class Way>
void describe_field(StageDescription<S>& d, Way way) {
  const auto field = &ScannerSettings::field;
  const auto mirror = &ScannerSettings::mirror;
  d.option("reach", way, &ScannerSettings::range, &RangeSettings::max_distance,
           "nothing comes back from beyond")
      .unit("m")
      .range(0.1, 65);
  d.option("first_angle", way, field, &FieldOfView::first, "reported angle of the first beam").unit("rad");
  d.option("last_angle", way, field, &FieldOfView::last, "reported angle of the last beam").unit("rad");
  d.option("step", way, field, &FieldOfView::step, "angle between beams").unit("rad").range(1e-4, 1);
  d.option("mirror_frequency", way, mirror, &MirrorSettings::frequency, "nominal rate of the mirrors")
      .unit("Hz")
      .range(1, 1000);
  d.option("mirror_slowest", way, mirror, &MirrorSettings::slowest,
           "each mirror's mean period is drawn: up to this share longer than nominal")
      .unit("1")
      .range(0, 0.1);
  d.option("mirror_wander", way, mirror, &MirrorSettings::wander, "largest slow departure of the period")
      .unit("1")
      .range(0, 0.1);
  d.option("mirror_jitter", way, mirror, &MirrorSettings::jitter, "standard deviation of each single period")
      .unit("1")
      .range(0, 0.01);
}

}  // namespace crisp
