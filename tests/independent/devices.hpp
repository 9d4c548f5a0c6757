// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <vector>

#include "tests/independent/effects.hpp"
#include "tests/independent/motion.hpp"
#include "tests/independent/population.hpp"
#include "tests/independent/scanner.hpp"
#include "tests/independent/wire.hpp"

namespace independent {

std::uint32_t read_clock(const ClockSetup& clock, double time);  ///< a device's clock at hub time `time` [µs]

/// A first-in, first-out way to the hub.
class Link {
 public:
  Link(const LinkSetup& setup, std::mt19937_64& random);
  double arrival(double sent);  ///< hub time at which what is sent at `sent` is complete [s]
  double smallest() const { return smallest_; }

 private:
  double minimum_, last_ = -1e9, smallest_ = 1e9;
  std::gamma_distribution<> extra_;
  std::mt19937_64& random_;
};

/// Packets of one device, and the smallest delay that any of its transmissions had [s].
struct Traffic {
  std::vector<Packet> packets;
  double smallest_delay = 0;
};

/// Sends scans of a laser (its index) as CoLa telegrams over TCP, with the hub's acknowledgements.
Traffic send_scans(const Setup& setup, std::size_t index, const std::vector<Scan>& scans,
                   const Effect& effect, std::mt19937_64 random);

/// Reads the encoder throughout the capture, and sends the plate's sentences over UDP.
Traffic send_readings(const Setup& setup, const PlateMotion& motion, const Effect& effect,
                      std::mt19937_64 random);

}  // namespace independent
