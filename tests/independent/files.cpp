// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/files.hpp"

#include <cstdio>
#include <fstream>
#include <numbers>
#include <stdexcept>

namespace independent {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

std::string number(double value, int digits = 10) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// A nominal value in its unit, with its standard deviation where the rig gives one.
std::string nominal(double value, double sd, const char* unit) {
  const std::string plain = number(value) + unit;
  return sd > 0 ? "{value: " + plain + ", sd: " + number(sd, 4) + unit + "}" : plain;
}

const char* yes_no(bool value) { return value ? "true" : "false"; }

void require_written(const std::ofstream& file, const std::string& path) {
  if (!file) throw std::runtime_error("cannot write " + path);
}

/// Under which name the rig's file has the device, which is another's if two addresses are exchanged.
std::string name_in_rig(const Setup& setup, const LaserSetup& device) {
  for (const LaserSetup& entry : setup.lasers) {
    const bool has_port = entry.rig_port == 0 || entry.rig_port == device.port;
    if (entry.rig_address == device.address && has_port) return entry.name;
  }
  return device.name;
}

}  // namespace

void write_rig(const std::string& path, const Setup& setup) {
  std::ofstream file(path);
  file << "crisp: 1\nlasers:\n";
  const Sd sd = setup.sd.value_or(Sd{});
  for (const auto& laser : setup.lasers) {
    const Geometry& g = laser.nominal;
    file << "  " << laser.name << ":\n    address: " << laser.rig_address << "\n";
    if (laser.rig_port) file << "    port: " << laser.rig_port << "\n";
    file << "    mount: " << number(laser.rig_mount * kDegrees) << "deg\n";
    if (laser.period_offset) file << "    period_offset: " << laser.period_offset << "\n";
    file << "    nominal:\n      lambda: "
         << nominal(g.lambda * kDegrees, &laser == setup.lasers.data() ? 0 : sd.lambda * kDegrees, "deg");
    file << "\n      tau: " << nominal(g.tau * 1000, sd.tau * 1000, "mm");
    file << "\n      alpha: " << nominal(g.alpha * kDegrees, sd.alpha * kDegrees, "deg") << "\n";
  }
  const auto& plate = setup.plate;
  file << "plate:\n  address: " << plate.address << "\n  port: " << plate.port
       << "\n  counts_per_revolution: " << number(plate.rig_counts)
       << "\n  direction: " << plate.rig_direction << "\n";
  require_written(file, path);
}

void write_truth(const std::string& path, const Setup& setup, const Effect& effect, const Outcome& outcome) {
  std::ofstream file(path);
  const auto& plate = setup.plate;
  file << "arguments: \"" << outcome.arguments << "\"\n";
  file << "scene: " << setup.scene << "\nmotion: " << setup.motion << "\nduration: " << number(setup.duration)
       << "\n";
  file << "turns: " << number(outcome.turns) << "\nrates: [" << number(outcome.slowest) << ", "
       << number(outcome.fastest) << "]\ntilt: " << number(setup.tilt) << "\nheight: " << number(setup.height)
       << "\n";
  file << "fault: " << setup.fault << "\nfault_detail: \"" << setup.fault_detail << "\"\n";
  const bool is_of_one = effect.laser >= 0;
  file << "effect: {cause: " << effect.cause << ", form: " << effect.form
       << ", scope: " << (is_of_one ? setup.lasers[static_cast<std::size_t>(effect.laser)].name : "all")
       << ", size: " << number(effect.size) << ", rms: " << number(outcome.effect_rms) << "}\n";
  file << "has_sd: " << yes_no(setup.sd.has_value()) << "\n";
  file << "plate: {direction: " << (plate.is_clockwise ? "clockwise" : "counter_clockwise")
       << ", counts: " << number(plate.counts) << ", rate: " << number(plate.rate)
       << ", rig_direction: " << plate.rig_direction << ", rig_counts: " << number(plate.rig_counts)
       << ", lost: " << number(plate.loss, 4) << ", joined: " << plate.readings_per_datagram << "}\n";
  file << "wire: {container: " << setup.wire.container << ", link: " << setup.wire.link
       << ", cola: " << (setup.wire.is_text ? "A" : "B") << ", retransmitted: " << number(setup.wire.loss, 4)
       << "}\n";
  file << "lasers:\n";
  for (std::size_t i = 0; i < setup.lasers.size(); ++i) {
    const auto& laser = setup.lasers[i];
    const double sample = outcome.smallest_plate_delay - outcome.smallest_delays[i] + laser.stamp_offset;
    file << "  " << laser.name << ": {name_in_rig: " << name_in_rig(setup, laser)
         << ", lambda: " << number(laser.truth.lambda) << ", tau: " << number(laser.truth.tau)
         << ", alpha: " << number(laser.truth.alpha) << ", eta: " << number(eta(setup, laser))
         << ", eta_sample: " << number(sample)
         << ", eta_from_minus_45: " << number(eta_from_minus_45(setup, laser))
         << ", mount: " << number(laser.mount) << ", kind: " << laser.kind.name
         << ", step_deg: " << number(laser.kind.step_deg) << ", rate: " << number(laser.kind.rate)
         << ", scans: " << outcome.scans[i] << ", sigma: " << number(laser.sigma, 4)
         << ", max_range: " << number(laser.max_range) << ", mixed_pixels: " << number(laser.mixed_pixels, 4)
         << ", stamp_offset: " << number(laser.stamp_offset) << ", period_offset: " << laser.period_offset
         << "}\n";
  }
  require_written(file, path);
}

}  // namespace independent
