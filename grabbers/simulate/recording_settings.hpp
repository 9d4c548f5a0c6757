// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>

#include "grabbers/simulate/device_clock.hpp"
#include "grabbers/simulate/link.hpp"
#include "grabbers/simulate/settings.hpp"
#include "grabbers/wire/cola.hpp"

namespace crisp::simulate {

/// Distribution of the devices' clocks: each starts anywhere within its 32 bits.
struct ClockSettings {
  double skew = 250e-6;  ///< largest |skew|
  double drift = 0;      ///< [1/s] largest |growth of the skew|
};

/// Whether telegrams carry remissions, and how wide.
enum class RemissionChannel { none, bits8, bits16 };

/// Content and timing of a laser's telegrams.
struct TelegramSettings {
  ColaLanguage language = ColaLanguage::B;
  RemissionChannel remission = RemissionChannel::bits8;
  double handover = 3.1e-3;        ///< [s] delay from the end of the mirror's turn to the transmission stamp
  double handover_jitter = 29e-6;  ///< [s] its standard deviation
  unsigned settling_scans = 0;     ///< so many scans after a start have device status 1: motor not at speed
};

/// From `begin` to `begin + duration` nothing comes from a device.
struct Silence {
  std::string device;
  double begin = 0;     ///< [s]
  double duration = 1;  ///< [s]
};

/// A device starts again: clock and counters from zero.
struct Restart {
  std::string device;
  double time = 0;  ///< [s]
};

/// Faults of the transmission.
struct FaultSettings {
  double lost_scans = 0;     ///< share of scan telegrams that are lost
  double lost_readings = 0;  ///< share of encoder readings that are lost
  std::vector<Silence> silences;
  std::vector<Restart> restarts;

  /// Whether the device is within one of its silences at this hub time [s].
  bool silent(const std::string& device, double time) const;
};

/// How one device's clock and link depart from those of the others: effects `clock.*` and `latency.*` of the
/// catalogue. The defaults change nothing.
struct DeviceEffects {
  double skew = 0;    ///< beyond what is drawn
  double drift = 0;   ///< [1/s] beyond what is drawn
  bool drawn = true;  ///< whether a skew and a drift are drawn besides
  Step clock;
  Step latency;
  double jitter = 0;  ///< [s] mean delay beyond the shortest; 0: its link's
  double shape = 1;   ///< of these delays' law; see LinkSettings
  BurstSettings bursts;
};

/// One device as it is: what clock alignment and calibration should find.
struct DeviceTruth {
  std::string name;
  DeviceClock clock;
  LinkSettings link;         ///< those of its kind, with its own jitter and bursts
  double minimum_delay = 0;  ///< [s] of its link
  Step latency;              ///< of the minimum delay
  double stamp_lag = 0;      ///< [s] delay of the scan's stamp beyond the rig's offsets
};

/// A recording of the scanner through its devices' clocks and telegrams.
struct RecordingSettings {
  ScannerSettings scanner;
  ClockSettings clocks;
  LinkSettings laser_link;
  LinkSettings plate_link{.minimum = 3e-4, .jitter = 5e-5};
  TelegramSettings telegrams;
  FaultSettings faults;
  std::vector<double> stamp_lags;                     ///< [s] one a laser; empty: none
  std::vector<DeviceEffects> device_effects;          ///< the lasers' and last the plate's; empty: none
  std::vector<DeviceClock> clock_overrides;           ///< the lasers' and last the plate's; empty: drawn
  std::int64_t start_ns = 1'767'225'600'000'000'000;  ///< [ns since the Unix epoch] hub time 0
};

/// The truth of a recording.
struct RecordingTruth {
  Calibration calibration;
  std::vector<DeviceTruth> lasers;
  DeviceTruth plate;
};

/// Draws the devices' clocks and sets their delays so that each laser has the η of the true calibration:
///
///     η = plate's minimum delay − laser's minimum delay − stamp lag
///
/// No delay is shorter than its link's minimum; the plate's is the shortest that allows this.
/// @throws Error if the settings make no sense
RecordingTruth draw_devices(const RecordingSettings& settings);

}  // namespace crisp::simulate
