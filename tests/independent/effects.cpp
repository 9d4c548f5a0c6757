// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/effects.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace independent {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMilli = 1e-3;

/// What the forms are made with: numbers drawn for this capture.
struct Drawn {
  double phase, phase2;  ///< [rad]
  double frequency;      ///< [Hz] of a slow sway
  double azimuth;        ///< [rad]
  double sign;           ///< −1 or 1
  double duration;       ///< [s]
  const PlateMotion& motion;
};

Pose tilted(const Pose& pose, double azimuth, double by) {
  return {pose.origin, rotated(pose.axes, {std::cos(azimuth), std::sin(azimuth), 0}, by)};
}
Pose shifted(const Pose& pose, Vector by) { return {pose.origin + by, pose.axes}; }

/// Rate of the plate, by differences.
double rate_at(const PlateMotion& motion, double time) {
  constexpr double kStep = 2e-3;
  return (motion.angle(time + kStep) - motion.angle(time - kStep)) / (2 * kStep);
}

/// Reading of an encoder whose coupling has play: it follows the shaft at half the play's width behind it.
std::vector<double> with_play(const PlateMotion& motion, double duration, double half, double step) {
  std::vector<double> readings;
  double reading = motion.angle(0);
  for (double time = 0; time <= duration + 2 * step; time += step) {
    const double angle = motion.angle(time);
    reading = std::clamp(reading, angle - half, angle + half);
    readings.push_back(reading - angle);
  }
  return readings;
}

double between(const std::vector<double>& values, double at) {
  const double clamped = std::clamp(at, 0.0, static_cast<double>(values.size()) - 1.001);
  const auto below = static_cast<std::size_t>(clamped);
  return std::lerp(values[below], values[below + 1], clamped - static_cast<double>(below));
}

double triangle(double turns) { return 4 * std::abs(turns - std::floor(turns + 0.5)) - 1; }

using Make = std::function<void(Effect&, const Drawn&)>;
struct Departure {
  std::string cause;
  Make make;
  /// Whether such a motion of the plate shows it. Without a change, it turns the plate's angles alike.
  std::function<bool(const PlateMotion&, double duration)> is_seen = [](const auto&, double) { return true; };
};

bool reverses(const PlateMotion& motion, double duration) {
  bool is_forth = false, is_back = false;
  for (double time = 0; time < duration; time += 0.05) {
    is_forth = is_forth || rate_at(motion, time) > 0.05;
    is_back = is_back || rate_at(motion, time) < -0.05;
  }
  return is_forth && is_back;
}

bool changes_rate(const PlateMotion& motion, double duration) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (double time = 0; time < duration; time += 0.05) {
    least = std::min(least, rate_at(motion, time));
    most = std::max(most, rate_at(motion, time));
  }
  return most - least > 0.3;
}

void add_base_forms(std::map<std::string, Departure>& forms) {
  forms["rocks"] = {"base.motion", [](Effect& e, const Drawn& d) {
                      e.pose = [=](const Pose& pose, double size, double time, double) {
                        return tilted(pose, d.azimuth,
                                      size * kMilli * std::sin(kTurn * d.frequency * time + d.phase));
                      };
                    }};
  forms["sinks"] = {"base.motion", [](Effect& e, const Drawn& d) {
                      e.pose = [=](const Pose& pose, double size, double time, double) {
                        return tilted(pose, d.azimuth, size * kMilli * time / d.duration);
                      };
                    }};
  forms["sways_twice"] = {"base.motion", [](Effect& e, const Drawn& d) {
                            e.pose = [=](const Pose& pose, double size, double time, double) {
                              const double one = std::sin(kTurn * d.frequency * time + d.phase);
                              const double two = std::sin(kTurn * 1.73 * d.frequency * time + d.phase2);
                              return shifted(pose,
                                             size * kMilli *
                                                 (one * Vector{std::cos(d.azimuth), std::sin(d.azimuth), 0} +
                                                  0.6 * two * Vector{0, 0, 1}));
                            };
                          }};
  forms["settles"] = {
      "base.motion", [](Effect& e, const Drawn& d) {
        e.pose = [=](const Pose& pose, double size, double time, double) {
          const double left = std::exp(-3 * time / d.duration);
          return shifted(tilted(pose, d.azimuth, size * kMilli * left), {0, 0, size * kMilli * left});
        };
      }};
}

void add_plate_forms(std::map<std::string, Departure>& forms) {
  forms["bearing"] = {"plate.wobble", [](Effect& e, const Drawn& d) {
                        e.pose = [=](const Pose& pose, double size, double, double angle) {
                          const double tilt =
                              std::cos(angle + d.phase) + 0.3 * std::cos(2 * angle + d.phase2);
                          return tilted(pose, d.azimuth, size * kMilli * tilt);
                        };
                      }};
  forms["third_harmonic"] = {"encoder.eccentricity", [](Effect& e, const Drawn& d) {
                               e.encoder = [=](double time) {
                                 const double angle = d.motion.angle(time);
                                 return kMilli *
                                        (std::sin(angle + d.phase) + 0.67 * std::sin(3 * angle + d.phase2));
                               };
                             }};
  forms["ring"] = {"encoder.eccentricity", [](Effect& e, const Drawn& d) {
                     e.encoder = [=](double time) {
                       const double angle = d.motion.angle(time);
                       return kMilli * (std::sin(angle + d.phase) + 0.35 * std::sin(2 * angle + d.phase2) +
                                        0.25 * std::cos(4 * angle));
                     };
                   }};
  forms["off_axis"] = {"encoder.eccentricity", [](Effect& e, const Drawn& d) {
                         e.encoder = [=](double time) {
                           const double angle = d.motion.angle(time);
                           return std::atan2(kMilli * std::sin(angle + d.phase),
                                             1 + kMilli * std::cos(angle + d.phase));
                         };
                       }};
  forms["play"] = {"encoder.backlash",
                   [](Effect& e, const Drawn& d) {
                     constexpr double kStep = 1e-3;
                     const auto play = std::make_shared<std::vector<double>>(
                         with_play(d.motion, d.duration, kMilli, kStep));
                     e.encoder = [=](double time) { return between(*play, time / kStep); };
                   },
                   reverses};
  forms["saturates"] = {"encoder.speed_lag",
                        [](Effect& e, const Drawn& d) {
                          e.encoder = [=](double time) {
                            const double rate = rate_at(d.motion, time);
                            return kMilli * d.sign * rate * rate * rate / (4 + rate * rate);
                          };
                        },
                        changes_rate};
  forms["cube"] = {"encoder.speed_lag",
                   [](Effect& e, const Drawn& d) {
                     e.encoder = [=](double time) {
                       const double rate = rate_at(d.motion, time);
                       return kMilli * d.sign * rate * rate * rate / 10;
                     };
                   },
                   changes_rate};
}

void add_mirror_forms(std::map<std::string, Departure>& forms) {
  forms["mirror_ring"] = {"mirror.eccentricity", [](Effect& e, const Drawn& d) {
                            e.mirror = [=](double theta) {
                              return kMilli *
                                     (std::sin(theta + d.phase) + 0.4 * std::sin(2 * theta + d.phase2));
                            };
                          }};
  forms["mirror_thrice"] = {"mirror.eccentricity", [](Effect& e, const Drawn& d) {
                              e.mirror = [=](double theta) {
                                return kMilli *
                                       (std::sin(theta + d.phase) + 0.5 * std::sin(3 * theta + d.phase2));
                              };
                            }};
  forms["bent_cone"] = {"mirror.cone", [](Effect& e, const Drawn& d) {
                          e.elevation = [=](double theta) {
                            return kMilli * d.sign * (1 + 0.3 * std::cos(2 * theta + d.phase));
                          };
                        }};
  forms["tilted_plane"] = {"mount.scan_plane_tilt",
                           [](Effect& e, const Drawn& d) { e.tilt = kMilli * d.sign; }};
}

void add_range_forms(std::map<std::string, Departure>& forms) {
  const auto add = [&](const std::string& name, const std::string& cause, auto departure) {
    forms[name] = {cause, [departure](Effect& e, const Drawn& d) {
                     e.range = [=](const Echo& echo) { return kMilli * d.sign * departure(echo, d); };
                   }};
  };
  add("slant", "range.incidence",
      [](const Echo& echo, const Drawn&) { return 1 / std::max(echo.incidence, 0.1) - 1; });
  add("tangent", "range.incidence", [](const Echo& echo, const Drawn&) {
    const double cosine = std::max(echo.incidence, 0.12);
    return (1 - cosine * cosine) / (cosine * cosine) * echo.range / 5;
  });
  add("cubed", "range.incidence",
      [](const Echo& echo, const Drawn&) { return std::pow(std::acos(std::min(1.0, echo.incidence)), 3); });
  add("walk", "range.intensity",
      [](const Echo& echo, const Drawn&) { return std::exp(-echo.remission / 150); });
  add("hyperbola", "range.intensity",
      [](const Echo& echo, const Drawn&) { return 1 / (1 + echo.remission / 40); });
  add("threshold", "range.intensity",
      [](const Echo& echo, const Drawn&) { return 1 / (1 + std::exp((echo.remission - 90) / 12)); });
  add("root", "range.warmup",
      [](const Echo& echo, const Drawn& d) { return std::sqrt(std::max(echo.time, 0.0) / d.duration); });
  add("saturation", "range.warmup", [](const Echo& echo, const Drawn& d) {
    return echo.time / (std::max(echo.time, 0.0) + d.duration / 4);
  });
  add("ramp", "range.warmup",
      [](const Echo& echo, const Drawn& d) { return std::min(1.0, 2 * echo.time / d.duration); });
  add("zigzag", "range.cyclic",
      [](const Echo& echo, const Drawn& d) { return triangle(echo.range / (0.6 + 0.1 * d.frequency)); });
  add("sawtooth", "range.cyclic", [](const Echo& echo, const Drawn& d) {
    const double turns = echo.range / (0.8 + 0.1 * d.frequency);
    return 2 * (turns - std::floor(turns)) - 1;
  });
  add("two_tones", "range.cyclic", [](const Echo& echo, const Drawn& d) {
    const double turned = kTurn * echo.range / (1 + 0.1 * d.frequency);
    return std::sin(turned + d.phase) + 0.5 * std::sin(2 * turned + d.phase2);
  });
  add("lobes", "shape", [](const Echo& echo, const Drawn& d) { return std::sin(3 * echo.theta + d.phase); });
  add("five_lobes", "shape", [](const Echo& echo, const Drawn& d) {
    return std::sin(2 * echo.theta + d.phase) * std::cos(5 * echo.theta + d.phase2);
  });
}

void add_clock_forms(std::map<std::string, Departure>& forms) {
  forms["breathes"] = {"clock.drift", [](Effect& e, const Drawn& d) {
                         e.clock = [=](double time) {
                           return kMilli * std::sin(kTurn * time / (0.8 * d.duration) + d.phase);
                         };
                       }};
  forms["cools"] = {"clock.drift", [](Effect& e, const Drawn& d) {
                      e.clock = [=](double time) {
                        return kMilli * d.sign * 2 * std::exp(-2 * time / d.duration);
                      };
                    }};
  forms["kinks"] = {"clock.drift", [](Effect& e, const Drawn& d) {
                      e.clock = [=](double time) {
                        return kMilli * d.sign * std::abs(time / d.duration - 0.45) * 4;
                      };
                    }};
}

void add_noise_forms(std::map<std::string, Departure>& forms) {
  forms["outbursts"] = {"noise.heavy_tail", [](Effect& e, const Drawn&) {
                          e.noise = [](const Echo&, double sigma, std::mt19937_64& random) {
                            return std::uniform_real_distribution<>()(random) < 0.08
                                       ? 8 * sigma * std::normal_distribution<>()(random)
                                       : 0.0;
                          };
                        }};
  forms["wide_spot"] = {"noise.mixed_pixels", [](Effect& e, const Drawn&) { e.spot = 0.015; }};
}

std::map<std::string, Departure> all_forms() {
  std::map<std::string, Departure> forms;
  forms["none"] = {"none", [](Effect&, const Drawn&) {}};
  add_base_forms(forms);
  add_plate_forms(forms);
  add_mirror_forms(forms);
  add_range_forms(forms);
  add_clock_forms(forms);
  add_noise_forms(forms);
  return forms;
}

/// Whether it can be that of one laser only.
bool is_of_a_laser(const Effect& effect) {
  return effect.mirror || effect.elevation || effect.range || effect.clock || effect.tilt != 0;
}

}  // namespace

Effect draw_effect(Draws& draws, int lasers, const PlateMotion& motion, double duration) {
  const auto forms = all_forms();
  std::vector<Draws::Weighted> names;
  for (const auto& [name, form] : forms) {
    if (form.is_seen(motion, duration)) names.push_back({name, 1.0});
  }
  Effect effect;
  const bool has_effect = draws.chance("has_effect", 0) || draws.is_fixed("effect");
  if (has_effect) effect.form = draws.choice("effect", names);
  const Departure& form = forms.at(effect.form);
  effect.cause = form.cause;
  const Drawn drawn{.phase = draws.uniform("effect_phase", 0, kTurn),
                    .phase2 = draws.uniform("effect_phase2", 0, kTurn),
                    .frequency = draws.uniform("effect_frequency", 0.4, 1.2),
                    .azimuth = draws.uniform("effect_azimuth", 0, kTurn),
                    .sign = draws.chance("effect_negative", 0.5) ? -1.0 : 1.0,
                    .duration = duration,
                    .motion = motion};
  form.make(effect, drawn);
  const int which = draws.integer("effect_laser", -1, lasers - 1);
  if (is_of_a_laser(effect)) effect.laser = effect.clock && which < 0 ? 0 : which;
  return effect;
}

}  // namespace independent
