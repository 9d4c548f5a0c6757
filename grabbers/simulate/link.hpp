// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "grabbers/simulate/device_clock.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {

/// How long a telegram travels from a device to the hub's network interface.
struct LinkSettings {
  double minimum = 1e-3;     ///< [s] shortest way that this kind of device can have
  double jitter = 1e-4;      ///< [s] mean of the delay beyond that, by Weibull's law
  double shape = 1;          ///< of that law; 1: exponential, below: a longer tail
  double stall_rate = 0.2;   ///< [1/s] rate of the link's stalls: telegrams sent meanwhile arrive in a burst
  double stall_time = 5e-3;  ///< [s] mean duration of a stall
  double seconds_per_byte = 80e-9;  ///< [s] 100 Mbit/s: telegrams follow each other no closer
};

/// Telegrams held back and handed on several at a time: `latency.bursts` of the catalogue.
struct BurstSettings {
  double together = 0;     ///< share of the telegrams that come together with the one before; 0: none
  double interval = 0.02;  ///< [s] between two telegrams, as they are sent
  double wait = 0;         ///< [s] standard deviation of their delays
};

/// A link that stalls so often and so long, at random, that telegrams come in such bursts.
///
/// @throws Error if no stalls make so many come together that wait so little
LinkSettings with_bursts(LinkSettings link, const BurstSettings& bursts);

/// The way of one device's telegrams: in order, late by at least a minimum of its own.
class Link {
 public:
  /// @param minimum  [s] this link's own, in place of the settings'
  /// @param name     of the device, for its random numbers
  /// @param step     of the minimum
  /// @throws Error if a time or rate is negative
  Link(const LinkSettings& settings, double minimum, std::uint64_t seed, const std::string& name,
       Step step = {});

  /// Hub time [s] at which a telegram arrives in full. Telegrams must be sent in order.
  double arrival(double sent, std::size_t bytes);

 private:
  LinkSettings settings_;
  double minimum_;
  double scale_;  // [s] of the jitter's law
  Step step_;
  statistics::RandomStream jitter_;
  statistics::RandomStream stalls_;
  double stall_begin_ = 0;
  double stall_end_ = 0;
  double last_arrival_;
};

}  // namespace crisp::simulate
