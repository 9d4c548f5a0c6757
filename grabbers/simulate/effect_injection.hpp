// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <crisp/scan.hpp>

#include "grabbers/simulate/effects.hpp"
#include "grabbers/simulate/recording_settings.hpp"

namespace crisp::simulate {

/// The catalogue's effects that can be injected into recorded scans, i.e. those of ranges and times.
std::vector<EffectInfo> injectable_effects(const TermRegistry& terms);

/// Effects injected into one laser's recorded scans. Instants count from the receipt of its first scan.
struct InjectedEffects {
  LaserEffects laser;
  DeviceEffects device;
  Step range;  ///< [m] by which its ranges grow
};

/// The injected effects of each laser of the rig. @param effects  of injectable_effects()
std::vector<InjectedEffects> injected_effects(const std::vector<Effect>& effects, const Rig& rig);

/// Changes the scans of one laser as if it had had these effects besides its own.
class EffectInjector {
 public:
  /// @param name  of the laser, for its random numbers
  EffectInjector(const InjectedEffects& effects, std::uint64_t seed, std::string name);

  /// Scans must come in the order of their receipt.
  Scan changed(const Scan& scan);

 private:
  void change_times(Scan& scan);
  void change_ranges(Scan& scan);

  InjectedEffects effects_;
  std::uint64_t seed_;
  std::string name_;
  std::optional<RangeNoise> noise_;  ///< none before the first scan
  std::uint32_t last_us_ = 0;        ///< the device's time of the last scan …
  std::int64_t elapsed_us_ = 0;      ///< … and since the first
  std::int64_t first_ns_ = 0;        ///< receipt of the first
};

}  // namespace crisp::simulate
