// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp::simulate {
namespace {

constexpr double kFirstPossibleBeam =
    -45 * data::kDegree;                  // reported angle that the mirror's index stands for
constexpr double kSmallestRange = 0.016;  // [m] what a device sends below is a code, not a range

/// Remission of an echo by a device of 8 bits.
float remission(const SpotEcho& echo) { return static_cast<float>(std::round(254 * echo.strength)); }

/// The range that the model's terms turn into the true distance: found by stepping, since terms are small.
double reported_range(const LaserChain& chain, std::span<const double> parameters, Beam<double> beam,
                      double distance) {
  if (chain.phases[static_cast<std::size_t>(Phase::kRange)].empty()) return distance;
  constexpr int kSteps = 200;
  constexpr double kClose = 1e-12;  // [m]
  beam.measured_range = distance;
  for (int step = 0; step < kSteps; ++step) {
    beam.range = beam.measured_range;
    model::apply_phase<double>(chain, Phase::kRange, parameters, {&beam, 1});
    const double miss = distance - beam.range;
    beam.measured_range += miss;
    if (std::abs(miss) < kClose) return beam.measured_range;
  }
  throw Error("the effects of a laser's range are so strong that a distance of " + std::to_string(distance) +
                  " m has no single range",
              "make them smaller");
}

void check(const ScannerSettings& settings) {
  if (settings.truth.lasers.size() != settings.rig.lasers.size()) {
    throw Error("the simulation's truth has " + std::to_string(settings.truth.lasers.size()) +
                    " lasers, but the rig has " + std::to_string(settings.rig.lasers.size()),
                "give the truth of each laser of the rig, in its order");
  }
  if (!settings.laser_effects.empty() && settings.laser_effects.size() != settings.rig.lasers.size()) {
    throw Error(fmt::format("the simulation has the effects of {} lasers, but the rig has {}",
                            settings.laser_effects.size(), settings.rig.lasers.size()),
                "give the effects of each laser, or none at all");
  }
  if (!settings.patterns.empty() && settings.patterns.size() != settings.rig.lasers.size()) {
    throw Error(fmt::format("the simulation has the field of view of {} lasers, but the rig has {}",
                            settings.patterns.size(), settings.rig.lasers.size()),
                "give the field of view of each laser, or one for all");
  }
  std::size_t most = 0;
  for (std::size_t i = 0; i < settings.rig.lasers.size(); ++i) {
    most = std::max(most, settings.pattern_of(i).field.beams());
  }
  for (const auto beam : settings.beams) {
    if (beam >= most) {
      throw Error("beam " + std::to_string(beam) + " is outside the field of view of " +
                      std::to_string(most) + " beams",
                  "give beams from 0 to " + std::to_string(most - 1));
    }
  }
}

std::vector<std::uint16_t> fired_beams(const ScannerSettings& settings, const FieldOfView& field) {
  std::vector<std::uint16_t> all(field.beams());
  std::iota(all.begin(), all.end(), std::uint16_t{0});
  if (settings.beams.empty()) return all;
  std::vector<std::uint16_t> chosen = settings.beams;
  std::erase_if(chosen, [&](std::uint16_t beam) { return beam >= all.size(); });
  return chosen;
}

}  // namespace

SweepSimulator::SweepSimulator(const ScannerSettings& settings, const Scene& scene, const Motion& motion,
                               const TermRegistry& terms)
    : settings_(settings), motion_(&motion), caster_(scene), model_(settings.truth, terms) {
  check(settings_);
  std::vector<double> reflectances;
  for (std::size_t k = 0; k < scene.things(); ++k) reflectances.push_back(scene.reflectance_of(k));
  for (std::size_t i = 0; i < settings_.rig.lasers.size(); ++i) {
    const auto& name = settings_.rig.lasers[i].name;
    const LaserEffects effects = settings_.effects_of(i);
    const ScanPattern pattern = settings_.pattern_of(i);
    MirrorSettings mirror = settings_.mirror;
    mirror.frequency = pattern.frequency;
    if (!effects.mirror_drawn) mirror.slowest = 0;
    if (effects.mirror_wander > 0) mirror.wander = Mirror::wander_of_rms(effects.mirror_wander);
    Laser& laser =
        lasers_.emplace_back(Laser{.mirror = Mirror(mirror, settings_.seed, name, effects.mirror_excess),
                                   .noise = RangeNoise(settings_.range, effects.noise, settings_.seed, name),
                                   .foliage = statistics::RandomStream(settings_.seed, name + ".foliage"),
                                   .spot = Spot(effects.noise, settings_.range.max_distance, reflectances),
                                   .upcoming = {},
                                   .field = pattern.field,
                                   .beams = fired_beams(settings_, pattern.field),
                                   .interleave = effects.interleave,
                                   .parameters = {}});
    laser.upcoming = laser.mirror.next();
    for (const auto slot : model_.chain(i).slots) {
      laser.parameters.push_back(model_.values()[static_cast<Eigen::Index>(slot)]);
    }
  }
}

Sweep SweepSimulator::next() {
  const auto earliest = std::min_element(lasers_.begin(), lasers_.end(), [](const auto& a, const auto& b) {
    return a.upcoming.begin < b.upcoming.begin;
  });
  Sweep sweep;
  sweep.laser = static_cast<std::uint16_t>(earliest - lasers_.begin());
  sweep.revolution = earliest->upcoming;
  sweep.beams = earliest->beams;
  earliest->upcoming = earliest->mirror.next();
  aim(*earliest, sweep);
  measure(*earliest, sweep);
  return sweep;
}

void SweepSimulator::aim(Laser& laser, Sweep& sweep) {
  const double eta = laser.parameters[3];
  const double mount = settings_.rig.lasers[sweep.laser].mount;
  const auto& beams = laser.beams;
  const double shift = laser.interleave.of(sweep.revolution.number);
  sweep.times.resize(beams.size());
  traced_.resize(beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double angle = laser.field.angle_of(beams[i]) + shift;
    const double turned = (angle - kFirstPossibleBeam) / (360 * data::kDegree);
    sweep.times[i] = sweep.revolution.begin + turned * sweep.revolution.period;
    traced_[i] = {};
    traced_[i].measured_mirror = angle - mount;
    traced_[i].hub_time = sweep.times[i] - eta;
    traced_[i].number = beams[i];
  }
  const auto known = std::make_unique<bool[]>(beams.size());  // a true motion knows every instant
  model::trace<double>(model_.chain(sweep.laser), laser.parameters, traced_, *motion_,
                       {known.get(), beams.size()});
}

void SweepSimulator::measure(Laser& laser, Sweep& sweep) {
  const std::size_t beams = laser.beams.size();
  sweep.ranges.assign(beams, 0);
  sweep.remissions.assign(beams, 0);
  sweep.cos_incidences.assign(beams, 0);
  sweep.surfaces.assign(beams, 0);
  for (std::size_t i = 0; i < beams; ++i) {
    const RangeNoise::Draw noise = laser.noise.draw(laser.beams[i]);
    Beam<double>& beam = traced_[i];
    const auto echo = laser.spot.echo(caster_, {beam.origin, beam.direction},
                                      {.time = sweep.times[i], .chance = &laser.foliage});
    if (!echo) continue;
    beam.remission = remission(*echo);
    beam.cos_incidence = echo->hit.cos_incidence;
    const double range =
        reported_range(model_.chain(sweep.laser), laser.parameters, beam, echo->hit.distance);
    const double reported = laser.noise.reported(
        {.range = range, .cosine = beam.cos_incidence, .remission = beam.remission}, noise);
    if (!(reported >= kSmallestRange)) continue;
    sweep.ranges[i] = static_cast<float>(reported);
    sweep.remissions[i] = static_cast<float>(beam.remission);
    sweep.cos_incidences[i] = static_cast<float>(beam.cos_incidence);
    sweep.surfaces[i] = echo->hit.surface;
  }
}

}  // namespace crisp::simulate
