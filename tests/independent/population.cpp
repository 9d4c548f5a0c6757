// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/population.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/independent/faults.hpp"

namespace independent {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kWrap = 4294967296.0;

std::string of(const char* what, std::size_t index) {
  return std::string(what) + "." + std::to_string(index + 1);
}

double draw_duration(Draws& draws) {
  const auto length = draws.choice("length", {{"short", 55}, {"middle", 28}, {"long", 14}, {"very_long", 3}});
  const auto [low, high] = length == "short"    ? std::pair(5, 10)
                           : length == "middle" ? std::pair(10, 16)
                           : length == "long"   ? std::pair(16, 30)
                                                : std::pair(30, 60);
  return draws.uniform("duration", low, high);
}

struct Mode {
  double step_deg;
  int beams;
  double rate;
};

Mode draw_mode(Draws& draws, const std::string& suffix, const std::vector<Mode>& modes) {
  return modes.at(
      static_cast<std::size_t>(draws.integer("mode" + suffix, 0, static_cast<int>(modes.size()) - 1)));
}

/// Angles, steps and rates from sick-cola.md and the data sheets.
LaserKind draw_kind(Draws& draws, const std::string& suffix) {
  const auto family = draws.choice("kind" + suffix, {{"lms1xx", 50}, {"lms5xx", 30}, {"circle360", 20}});
  if (family == "lms1xx") {
    const Mode mode = draw_mode(draws, suffix, {{0.5, 541, 50}, {0.25, 1081, 25}});
    return {family, -45, mode.step_deg, mode.beams, mode.rate, 1, 1.4e-3, 3.3e-3, 30e-6};
  }
  if (family == "lms5xx") {
    const Mode mode =
        draw_mode(draws, suffix,
                  {{0.5, 381, 50}, {0.5, 381, 35}, {0.25, 761, 35}, {0.25, 761, 25}, {1.0 / 6, 1141, 25}});
    return {family, -5, mode.step_deg, mode.beams, mode.rate, 0, 0.3e-3, 1.0e-3, 100e-6};
  }
  const Mode mode =
      draw_mode(draws, suffix, {{0.5, 720, 10}, {0.5, 720, 15}, {0.5, 720, 20}, {0.5, 720, 25}});
  return {family, 0, mode.step_deg, mode.beams, mode.rate, 1, 1e-3, 3e-3, 100e-6};
}

double draw_mount(Draws& draws, const std::string& suffix) {
  const bool is_odd = draws.chance("odd_mount" + suffix, 0.25);
  const double multiple = 45.0 * draws.integer("mount_eighths" + suffix, 0, 3);
  const double odd = std::round(draws.uniform("odd_mount_angle" + suffix, -1800, 1800)) / 10;
  const double drawn = is_odd ? odd : multiple;
  return kDegree * draws.uniform("mount" + suffix, drawn, drawn);
}

LinkSetup draw_link(Draws& draws, const std::string& suffix) {
  return {draws.uniform("min_delay" + suffix, 0.2e-3, 3e-3),
          draws.uniform("extra_delay" + suffix, 0.1e-3, 1.5e-3),
          draws.uniform("delay_shape" + suffix, 0.6, 2)};
}

ClockSetup draw_clock(Draws& draws, const std::string& suffix, double duration) {
  ClockSetup clock{std::floor(draws.uniform("clock_start" + suffix, 0, kWrap)),
                   draws.uniform("skew" + suffix, -1e-4, 1e-4)};
  if (draws.chance("clock_wraps" + suffix, 0.08)) {
    clock.start = kWrap - std::floor(1e6 * duration * draws.uniform("clock_wrap_at" + suffix, 0.1, 0.9));
  }
  return clock;
}

/// Nominal azimuths in whole degrees, 0 for the first laser.
std::vector<double> draw_azimuths(Draws& draws, int lasers) {
  std::vector<double> azimuths = {0};
  if (draws.choice("azimuths", {{"even", 60}, {"uneven", 40}}) == "even") {
    const double sense = draws.chance("numbered_clockwise", 0.25) ? -1 : 1;
    for (int i = 1; i < lasers; ++i) azimuths.push_back(sense * std::round(360.0 * i / lasers));
    return azimuths;
  }
  auto random = draws.stream("uneven_azimuths");
  while (static_cast<int>(azimuths.size()) < lasers) {
    const double azimuth = std::round(std::uniform_real_distribution<>(-180, 180)(random));
    const bool is_free = std::all_of(azimuths.begin(), azimuths.end(), [&](double other) {
      return std::abs(std::remainder(azimuth - other, 360)) >= 20;
    });
    if (is_free) azimuths.push_back(azimuth);
  }
  return azimuths;
}

double draw_orientation(Draws& draws, std::size_t index) {
  const auto pattern =
      draws.choice("orientation", {{"tangential", 50}, {"radial", 25}, {"upside_down", 10}, {"mixed", 15}});
  const double radial = draws.chance("radial_inward", 0.5) ? -90 : 90;
  if (pattern == "tangential") return 0;
  if (pattern == "radial") return radial;
  if (pattern == "upside_down") return 180;
  return -90 + 90.0 * draws.integer(of("mixed_orientation", index), 0, 3);
}

/// Truth = nominal + departure: normal within 2.5 sd where the rig gives an sd, even otherwise.
void draw_geometry(Draws& draws, Setup& setup) {
  const auto azimuths = draw_azimuths(draws, static_cast<int>(setup.lasers.size()));
  const bool has_own_tau = draws.chance("own_tau", 1.0 / 3);
  if (draws.chance("has_sd", 0.5)) {
    setup.sd = Sd{kDegree * draws.uniform("sd_lambda", 1, 5), draws.uniform("sd_tau", 2e-3, 20e-3),
                  kDegree * draws.uniform("sd_alpha", 1, 3)};
  }
  for (std::size_t i = 0; i < setup.lasers.size(); ++i) {
    auto& laser = setup.lasers[i];
    const auto depart = [&](const char* what, double sd, double bound) {
      return sd > 0 ? draws.truncated_normal(of(what, i), sd, 2.5)
                    : draws.uniform(of(what, i), -bound, bound);
    };
    const Sd sd = setup.sd.value_or(Sd{});
    laser.nominal.lambda = kDegree * azimuths[i];
    laser.nominal.tau = std::round(100 * draws.uniform(has_own_tau ? of("tau", i) : "tau", 0, 0.5)) / 100;
    laser.nominal.alpha = kDegree * draw_orientation(draws, i);
    laser.truth.lambda =
        i == 0 ? 0 : wrapped(laser.nominal.lambda + depart("lambda_error", sd.lambda, 5 * kDegree));
    laser.truth.tau = std::abs(laser.nominal.tau + depart("tau_error", sd.tau, 0.02));
    laser.truth.alpha = wrapped(laser.nominal.alpha + depart("alpha_error", sd.alpha, 3 * kDegree));
  }
}

void draw_lasers(Draws& draws, Setup& setup) {
  const bool is_mixed = draws.chance("mixed_kinds", 1.0 / 3), has_own_mount = draws.chance("own_mount", 0.2);
  const bool has_offset = draws.chance("has_stamp_offset", 0.2),
             has_mixed_pixels = draws.chance("has_mixed_pixels", 0.1);
  const char* names[] = {"front", "left", "rear", "right", "upper", "lower"};
  for (std::size_t i = 0; i < setup.lasers.size(); ++i) {
    auto& laser = setup.lasers[i];
    laser.name = i < 6 ? names[i] : "unit" + std::to_string(i + 1);
    laser.kind = draw_kind(draws, is_mixed ? of("", i) : "");
    laser.mount = draw_mount(draws, has_own_mount ? of("", i) : "");
    const std::string kind = "." + laser.kind.name;
    laser.stamp_offset = has_offset ? draws.uniform("stamp_offset" + kind, -3e-3, 3e-3) : 0;
    laser.period_offset = draws.chance("stamps_late" + kind, 0.15) ? -1 : 0;
    laser.sigma = draws.uniform("sigma" + kind, 5e-3, 15e-3);
    laser.max_range = std::round(draws.uniform("max_range" + kind, 20, 50));
    laser.mixed_pixels = has_mixed_pixels ? draws.uniform("mixed_pixels" + kind, 0.2, 1) : 0;
    laser.processing =
        draws.uniform(of("processing", i), laser.kind.processing_low, laser.kind.processing_high);
    if (laser.period_offset < 0) laser.processing = std::max(laser.processing, 0.5e-3 - laser.stamp_offset);
    laser.slowness = draws.uniform(of("slowness", i), 0, 0.006);
    laser.wander = draws.uniform(of("wander", i), 0.001, 0.002);
    laser.link = draw_link(draws, of("", i));
    laser.clock = draw_clock(draws, of("", i), setup.duration);
  }
}

void draw_plate(Draws& draws, Setup& setup) {
  auto& plate = setup.plate;
  plate.counts = std::round(draws.log_uniform("counts", 1000, 100000));
  plate.is_clockwise = draws.chance("clockwise", 0.5);
  plate.rate = std::round(draws.uniform("readings", 100, 1000));
  plate.start_count =
      draws.chance("counts_from_zero", 0.5) ? 0 : std::floor(draws.uniform("start_count", 0, kWrap));
  plate.readings_per_datagram = draws.chance("joined_readings", 0.15) ? draws.integer("joined", 2, 4) : 1;
  plate.link = draw_link(draws, ".plate");
  plate.clock = draw_clock(draws, ".plate", setup.duration);
  plate.rig_counts = plate.counts;
  plate.rig_direction = draws.chance("auto_direction", 0.1) ? "auto"
                        : plate.is_clockwise                ? "clockwise"
                                                            : "counter_clockwise";
}

void draw_network(Draws& draws, Setup& setup) {
  auto& wire = setup.wire;
  wire.container = draws.choice(
      "container",
      {{"pcap_us", 50}, {"pcap_ns", 20}, {"pcap_us_big", 10}, {"pcap_ns_big", 5}, {"pcapng", 15}});
  wire.link = draws.choice(
      "link", {{"ethernet", 60}, {"vlan", 10}, {"sll", 10}, {"sll2", 8}, {"raw", 8}, {"loopback", 4}});
  wire.is_text = draws.chance("cola_a", 0.3);
  wire.has_handshake = draws.chance("handshake", 0.5);
  wire.has_name = draws.chance("device_name", 0.2);
  wire.has_time = draws.chance("device_time", 0.5);
  if (draws.chance("lossy", 0.1)) {
    wire.loss = draws.uniform("retransmitted", 0.001, 0.01);
    setup.plate.loss = draws.uniform("lost_datagrams", 0.001, 0.01);
  }
  const std::string net = "192.168." + std::to_string(draws.integer("net", 0, 200)) + ".";
  wire.hub = net + "100";
  const bool is_one_address = draws.chance("one_address", 1.0 / 12),
             names_ports = draws.chance("rig_ports", 0.4);
  const int port = draws.chance("port_2112", 0.4) ? 2112 : 2111;
  for (std::size_t i = 0; i < setup.lasers.size(); ++i) {
    auto& laser = setup.lasers[i];
    laser.address = net + std::to_string(is_one_address ? 10 : 11 + i);
    laser.port = is_one_address ? 2111 + static_cast<int>(i) : port;
    laser.rig_address = laser.address;
    laser.rig_port = is_one_address || names_ports ? laser.port : 0;
  }
  setup.plate.address = net + (is_one_address ? "10" : "50");
  setup.plate.port = draws.chance("plate_port_4000", 0.7) ? 4000 : draws.integer("plate_port", 5000, 9000);
}

}  // namespace

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

double eta(const Setup& setup, const LaserSetup& laser) {
  return setup.plate.link.minimum - laser.link.minimum + laser.stamp_offset;
}

double eta_from_minus_45(const Setup& setup, const LaserSetup& laser) {
  const double period = 1 / (laser.kind.rate * (1 - laser.slowness));
  return eta(setup, laser) - (laser.kind.start_deg + 45) / 360 * period;
}

Setup draw_setup(Draws& draws) {
  Setup setup;
  setup.scene =
      draws.choice("scene", {{"office", 25}, {"hall", 20}, {"street", 20}, {"tunnel", 15}, {"workshop", 20}});
  setup.motion = draws.choice(
      "motion", {{"varied", 50}, {"reversal", 20}, {"stop_and_go", 15}, {"ripple", 10}, {"constant", 5}});
  setup.duration = draw_duration(draws);
  setup.height = draws.uniform("height", 0.8, 1.8);
  setup.yaw = draws.uniform("yaw", -std::numbers::pi, std::numbers::pi);
  setup.tilt = draws.chance("tilted", 0.1) ? kDegree * draws.uniform("tilt", 5, 90) : 0;
  setup.tilt_azimuth = draws.uniform("tilt_azimuth", -std::numbers::pi, std::numbers::pi);
  const int lasers =
      std::stoi(draws.choice("lasers", {{"1", 15}, {"2", 25}, {"3", 30}, {"4", 20}, {"5", 5}, {"6", 5}}));
  setup.lasers.resize(static_cast<std::size_t>(lasers));
  draw_geometry(draws, setup);
  draw_lasers(draws, setup);
  draw_plate(draws, setup);
  draw_network(draws, setup);
  for (auto& laser : setup.lasers) laser.rig_mount = laser.mount;
  draw_fault(draws, setup);
  return setup;
}

}  // namespace independent
