// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "grabbers/simulate/motion.hpp"
#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp::test {

/// A recording drawn from one seed: scanner, scene, motion and effects.
struct Drawn {
  std::string scene;
  std::string motion;
  std::vector<std::string> names;  ///< of the effects: "laser2.mirror.cone"
  std::vector<double> sizes;       ///< [m] RMS change of ranges by each; smaller than requested at its bounds
  std::string covariate;           ///< of an unmodeled error
  Recording recording;

  /// Whether each effect changes ranges by nearly the requested size [m].
  bool reaches(double size) const {
    constexpr double kNearly = 0.9;
    return std::ranges::all_of(sizes, [&](double reached) { return reached >= kNearly * size; });
  }
};

/// The causes of the catalogue.
inline std::vector<std::string> causes() {
  std::vector<std::string> names;
  for (const auto& name : built_in_terms().names()) {
    const TermInfo& info = built_in_terms().get(name)->info();
    if (info.covariate.empty() && !info.is_nuisance) names.push_back(name);
  }
  return names;
}

/// Different causes, drawn from a seed.
inline std::vector<std::string> some_causes(std::size_t count, std::uint64_t seed) {
  std::vector<std::string> names = causes();
  std::mt19937_64 random(seed + 1'000'000);
  std::ranges::shuffle(names, random);
  names.resize(count);
  return names;
}

/// Draws recordings of ten seconds.
class Drawer {
 public:
  /// @param rig  of a scanner that agrees with it; otherwise rig and the scanner's deviations from it are
  /// drawn
  explicit Drawer(std::uint64_t seed, const std::optional<Rig>& rig = {}) : random_(seed) {
    scanner().seed = seed;
    draw_scene();
    if (rig) {
      scanner().rig = *rig;
      scanner().truth = nominal_calibration(*rig);
    } else {
      draw_rig();
    }
    draw_motion();
  }

  /// Simulates effects, given by their names without owner, each of `size` [m].
  Drawn with(const std::vector<std::string>& effects, double size) {
    for (const std::string& effect : effects) hide(effect, size);
    return record();
  }

  /// Simulates one of the errors that no term of the catalogue describes: see unmodeled_errors.hpp.
  Drawn with_something_else(std::size_t which, double size);

 private:
  simulate::ScannerSettings& scanner() { return drawn_.recording.scanner; }
  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  double normal() { return std::normal_distribution()(random_); }
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  void draw_scene() {
    static const std::array<std::string, 3> kNames = {"office", "hall", "street"};
    drawn_.scene = kNames[below(kNames.size())];
    scene_ = simulate::built_in_scene(drawn_.scene);
  }

  /// Two to four lasers with mounting errors against the rig.
  void draw_rig() {
    const std::size_t lasers = 2 + below(3);
    const RigLaser like = default_rig().lasers.front();
    Rig rig = default_rig();
    rig.lasers.clear();
    for (std::size_t k = 0; k < lasers; ++k) {
      RigLaser laser = like;
      laser.name = "laser" + std::to_string(k + 1);
      laser.nominal.name = laser.name;
      laser.nominal.lambda.value =
          2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(lasers) +
          (k > 0 ? uniform(-0.15, 0.15) : 0);
      laser.nominal.tau.value = uniform(0.15, 0.25);
      laser.nominal.alpha.value = uniform(-0.1, 0.1);
      rig.lasers.push_back(laser);
    }
    scanner().rig = rig;
    scanner().truth = nominal_calibration(rig);
    for (std::size_t k = 0; k < lasers; ++k) {
      LaserCalibration& laser = scanner().truth.lasers[k];
      if (k > 0) laser.lambda.value += 0.01 * normal();
      laser.tau.value += 0.003 * normal();
      laser.alpha.value += 0.01 * normal();
      laser.eta.value += 0.002 * normal();
    }
  }

  void draw_motion() {
    simulate::MotionSettings& motion = scanner().motion;
    motion.max_rate = uniform(1, 2);
    switch (below(3)) {
      case 0:
        drawn_.motion = "varying";
        motion.min_rate = uniform(0, 0.5);
        break;
      case 1:
        drawn_.motion = "both ways";
        motion.min_rate = -motion.max_rate;
        break;
      default:
        drawn_.motion = "reversal";
        motion.kind = simulate::MotionKind::reversal;
    }
  }

  void draw_parameters(TermParameters& term) {
    const auto& declared = built_in_terms().get(term.term)->info().parameters;
    for (std::size_t k = 0; k < declared.size(); ++k) {
      const EffectParameter& p = declared[k];
      const double share = uniform(0.2, 0.8);
      double& value = term.parameters[k].value;
      if (!p.shape) {
        value = p.neutral + normal() * 1e-3 * (p.upper - p.lower);
      } else if (p.tries.spacing == Tries::Spacing::kInstants) {
        value = share * scanner().duration;
      } else if (p.tries.count > 0) {
        value = p.tries.from * std::pow(p.tries.to / p.tries.from, share);
      }
    }
  }

  /// Scales a term such that the RMS change of ranges is `size`.
  void scale(const std::string& name, double size) {
    TermParameters& term = term_of(scanner().truth, name);
    const auto& declared = built_in_terms().get(term.term)->info().parameters;
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      const double factor = size / change_of_ranges(name);
      for (std::size_t k = 0; k < declared.size(); ++k) {
        const EffectParameter& p = declared[k];
        double& value = term.parameters[k].value;
        if (!p.shape) value = std::clamp(p.neutral + (value - p.neutral) * factor, p.lower, p.upper);
      }
    }
  }

  /// [m] RMS change of the ranges of the affected lasers by a term of the truth: difference of two noise-free
  /// recordings, without beams that meet different surfaces.
  double change_of_ranges(const std::string& name) {
    simulate::ScannerSettings with = scanner();
    with.range.sigma = 0;
    with.beams.clear();
    constexpr std::size_t kEvery = 12;
    for (std::size_t beam = 0; beam < with.field.beams(); beam += kEvery) {
      with.beams.push_back(static_cast<std::uint16_t>(beam));
    }
    simulate::ScannerSettings without = with;
    std::erase_if(without.truth.plate_terms, [&](const auto& term) { return term.term == name; });
    for (auto& laser : without.truth.lasers) {
      std::erase_if(laser.terms, [&](const auto& term) { return laser.name + "." + term.term == name; });
    }
    return rms_change(simulate::simulate_measurements(with, scene_, built_in_terms()).beams,
                      simulate::simulate_measurements(without, scene_, built_in_terms()).beams);
  }

  static double rms_change(const Measurements& a, const Measurements& b) {
    constexpr double kOtherThing = 0.05;  // [m]
    const auto key = [](const Measurements& m, std::size_t i) { return std::tuple(m.laser[i], m.time[i]); };
    std::map<std::tuple<std::uint16_t, double>, float> ranges;
    for (std::size_t i = 0; i < b.size(); ++i) ranges[key(b, i)] = b.range[i];
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto other = ranges.find(key(a, i));
      if (other == ranges.end()) continue;
      const double change = double{a.range[i]} - double{other->second};
      if (change == 0 || std::abs(change) > kOtherThing) continue;
      squares += change * change;
      ++count;
    }
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
  }

  void hide(const std::string& effect, double size) {
    const bool of_plate = built_in_terms().get(effect)->info().scope == Scope::kPlate;
    const std::string name =
        of_plate ? effect : "laser" + std::to_string(1 + below(scanner().rig.lasers.size())) + "." + effect;
    estimate::add_requested_terms(scanner().truth, {name}, built_in_terms());
    draw_parameters(term_of(scanner().truth, name));
    scale(name, size);
    drawn_.names.push_back(name);
    drawn_.sizes.push_back(change_of_ranges(name));
  }

  Drawn record() {
    drawn_.recording.made = simulate::simulate_measurements(scanner(), scene_, built_in_terms());
    return std::move(drawn_);
  }

  std::mt19937_64 random_;
  simulate::Scene scene_;
  Drawn drawn_;
};

}  // namespace crisp::test
