// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/independent/check.hpp"
#include "tests/independent/devices.hpp"
#include "tests/independent/effects.hpp"
#include "tests/independent/files.hpp"
#include "tests/independent/population.hpp"

namespace independent {
namespace {

constexpr const char* kUsage =
    "usage: independent_scanner SEED FOLDER [NAME=VALUE...]\n"
    "       independent_scanner check FOLDER\n"
    "Draws a rig from SEED and writes FOLDER/capture.pcap, rig.yaml and truth.yaml; NAME=VALUE fixes a draw,\n"
    "such as duration=8 scene=office motion=varied fault=none lasers=3 kind=lms1xx orientation=radial.\n"
    "check projects a capture's beams with the truth, and reports their residuals from the scene.\n";

/// Gives the effect its size: `effect_amount` in its own unit (1 mm, 1 mrad or 1 ms), or else `effect_rms`
/// [mm], by which it changes ranges.
///
/// @return by how much it changes ranges [m]
double scale_effect(Draws& draws, const Setup& setup, const World& world, const PlateMotion& motion,
                    Effect& effect) {
  const double target = 1e-3 * draws.log_uniform("effect_rms", 3, 20);
  const double amount = draws.uniform("effect_amount", 1, 1);
  const auto rms = [&] { return effect_rms(setup, world, motion, effect, draws.stream("effect.beams")); };
  effect.size = amount;
  if (draws.is_fixed("effect_amount")) return rms();
  for (int i = 0; i < 3; ++i) effect.size *= rms() > 0 ? target / rms() : 1;
  return rms();
}

void simulate(const std::string& seed, const std::string& folder,
              const std::map<std::string, std::string>& fixed) {
  Outcome outcome;
  outcome.arguments = seed;
  for (const auto& [name, value] : fixed)
    outcome.arguments.append(" ").append(name).append("=").append(value);
  Draws draws(std::stoull(seed), fixed);
  const Setup setup = draw_setup(draws);
  const World world = build_scene(setup.scene, setup.height, draws.stream("scene.solids"));
  const PlateMotion motion = draw_motion(setup.motion, setup.duration, draws.stream("motion.path"));
  Effect effect = draw_effect(draws, static_cast<int>(setup.lasers.size()), motion, setup.duration);
  outcome.effect_rms = scale_effect(draws, setup, world, motion, effect);
  draws.require_all_used();
  constexpr double kTurn = 6.283185307179586;
  outcome.turns = motion.range() / kTurn;
  outcome.slowest = motion.slowest() / kTurn;
  outcome.fastest = motion.fastest() / kTurn;
  const Traffic readings = send_readings(setup, motion, effect, draws.stream("readings.noise"));
  outcome.smallest_plate_delay = readings.smallest_delay;
  std::vector<Packet> packets = readings.packets;
  for (std::size_t i = 0; i < setup.lasers.size(); ++i) {
    const LaserSetup& laser = setup.lasers[i];
    const auto scans = simulate_scans(setup, i, world, motion, effect, draws.stream("scans." + laser.name));
    const Traffic traffic = send_scans(setup, i, scans, effect, draws.stream("telegrams." + laser.name));
    if (!laser.is_silent) packets.insert(packets.end(), traffic.packets.begin(), traffic.packets.end());
    outcome.smallest_delays.push_back(traffic.smallest_delay);
    outcome.scans.push_back(laser.is_silent ? 0 : scans.size());
  }
  std::filesystem::create_directories(folder);
  auto random = draws.stream("epoch");
  const auto epoch =
      std::uniform_int_distribution<std::int64_t>(1600000000, 1800000000)(random) * 1000000000 + 123456789;
  write_capture(folder + "/capture.pcap", std::move(packets), setup.wire.container, setup.wire.link, epoch);
  write_rig(folder + "/rig.yaml", setup);
  write_truth(folder + "/truth.yaml", setup, effect, outcome);
}

int run(int count, char** values) {
  const std::string first = count > 1 ? values[1] : "";
  if (first == "check" && count == 3) return check(values[2]) ? 0 : 1;
  if (count < 3 || first.find_first_not_of("0123456789") != std::string::npos) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  std::map<std::string, std::string> fixed;
  for (int i = 3; i < count; ++i) {
    const std::string argument = values[i];
    const auto equals = argument.find('=');
    if (equals == std::string::npos) throw std::runtime_error(argument + " is no NAME=VALUE");
    fixed[argument.substr(0, equals)] = argument.substr(equals + 1);
  }
  simulate(first, values[2], fixed);
  return 0;
}

}  // namespace
}  // namespace independent

int main(int count, char** values) {
  try {
    return independent::run(count, values);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "independent_scanner: %s\n", error.what());
    return 2;
  }
}
