// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/independent/draws.hpp"

namespace independent {

/// Properties of a device type.
struct LaserKind {
  std::string name;
  double start_deg = 0;  ///< reported angle of the first beam
  double step_deg = 0;   ///< exact, also where the telegram rounds it
  int beams = 0;
  double rate = 0;                                 ///< nominal mirror turns a second [Hz]
  int version = 1;                                 ///< field of the telegram
  double processing_low = 0, processing_high = 0;  ///< [s] from an index pulse to transmission
  double processing_jitter = 0;                    ///< [s] its standard deviation within one device
};

/// Way from a device to the hub: a minimum delay, and more that is gamma-distributed.
struct LinkSetup {
  double minimum = 0;  ///< [s]
  double mean_extra = 0, shape = 1;
};

/// A device's clock reads start + 1e6 (1 + skew) t [µs] at hub time t, modulo 2^32.
struct ClockSetup {
  double start = 0, skew = 0;
};

struct Geometry {
  double lambda = 0, tau = 0, alpha = 0;  ///< [rad], [m], [rad]
};

struct LaserSetup {
  std::string name;
  LaserKind kind;
  double mount = 0;  ///< [rad]
  Geometry truth, nominal;
  double stamp_offset = 0;  ///< [s] from the time stamp (less whole periods) to the first beam reported
  int period_offset = 0;    ///< 0, or -1: stamp is the index pulse that ends the scan
  double slowness = 0;      ///< share by which the mirror turns slower than nominal
  double wander = 0;        ///< largest relative departure of the mirror's speed
  double processing = 0;    ///< [s] from the index pulse that ends the scan to transmission
  double sigma = 0, max_range = 0;  ///< [m]
  double mixed_pixels = 0;  ///< share of the beams across an edge that return a range between both surfaces
  LinkSetup link;
  ClockSetup clock;
  std::string address;
  int port = 2111;
  // The rig file's values, and a fault of the set-up.
  double rig_mount = 0;
  std::string rig_address;
  int rig_port = 0;  ///< 0: not written
  bool is_silent = false;
};

struct PlateSetup {
  double counts = 0;          ///< steps a revolution
  bool is_clockwise = false;  ///< the count grows as the plate turns clockwise seen from +z
  double rate = 0;            ///< readings a second
  double start_count = 0;
  int readings_per_datagram = 1;
  double loss = 0;  ///< share of datagrams that never arrive
  LinkSetup link;
  ClockSetup clock;
  std::string address;
  int port = 4000;
  std::string rig_direction;
  double rig_counts = 0;
  std::vector<std::pair<double, double>> slips;  ///< time [s], jump of the encoder [rad]
};

struct WireSetup {
  std::string container, link;  ///< see wire.hpp
  bool is_text = false;         ///< CoLa-A
  bool has_handshake = false, has_name = false, has_time = false;
  double loss = 0;  ///< share of TCP segments that are sent a second time, 0.2 s later
  std::string hub;
};

struct Sd {
  double lambda = 0, tau = 0, alpha = 0;
};

struct Setup {
  std::string scene, motion;
  double duration = 0;                                     ///< [s]
  double height = 0, yaw = 0, tilt = 0, tilt_azimuth = 0;  ///< pose of the plate in the scene [m], [rad]
  std::vector<LaserSetup> lasers;
  PlateSetup plate;
  WireSetup wire;
  std::optional<Sd> sd;  ///< of the nominal values, where the rig file gives them
  std::string fault, fault_detail;
};

/// Draws a rig, its scene, its motion and its fault from the population.
///
/// Draws that are handy to fix: scene, motion, duration, lasers, kind, mode (index of a kind's step and
/// rate), mount [deg], orientation (tangential, radial, upside_down, mixed), azimuths (even, uneven), tau
/// [m], has_sd, counts, clockwise, auto_direction, readings, fault, mount_fault [deg], tilt [deg] with
/// tilted=1, has_stamp_offset, stamp_offset [s], stamps_late, sigma [m], max_range [m], has_mixed_pixels,
/// lossy, cola_a, container, link.
Setup draw_setup(Draws& draws);

/// η as capture.md defines it: the plate's minimum delay less the laser's, and the fixed offset [s].
double eta(const Setup& setup, const LaserSetup& laser);

/// η if the stamp is taken for the time of a beam at −45°, whatever the device's first angle [s].
///
/// capture.md defines "first possible beam (−45°)"; a 190° or 360° unit has no such beam, and this program
/// stamps the first beam that the unit reports. A reader that counts beams from −45° finds this value.
double eta_from_minus_45(const Setup& setup, const LaserSetup& laser);

double wrapped(double angle);  ///< to (−π, π]

}  // namespace independent
