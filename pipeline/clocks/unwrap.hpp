// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace crisp::clocks {

/// [ns since the Unix epoch] The epoch of a run whose first item was received then: the nearest whole second,
/// so that times in a run are small numbers.
std::int64_t epoch_of_run(std::int64_t first_receipt_ns);

/// The number nearest to `expected` that leaves `residue` when divided by `modulus`: unwraps a counter.
std::int64_t nearest_congruent(std::int64_t residue, std::int64_t modulus, double expected);

/// A telegram's receipt on the hub's clock, and its time on the device's clock.
struct DeviceStamp {
  std::int64_t receipt_ns = 0;  ///< [ns since the Unix epoch]
  std::uint32_t device_us = 0;  ///< [µs] modulo 2³²
};

/// Time between two stamps on both clocks.
struct ElapsedTime {
  double hub_s = 0;            ///< [s]
  std::int64_t device_us = 0;  ///< [µs] nearest to the hub's time, which resolves the wraps
};
ElapsedTime elapsed(const DeviceStamp& from, const DeviceStamp& to);

/// Unwraps a 16-bit counter, also across a gap of several wraps.
class CounterUnwrapper {
 public:
  /// @param raw       the counter as sent
  /// @param expected  how far it should have come since the one before, by any other clock
  /// @return how far it has come: the possible number nearest to `expected`, negative for one that is late
  std::int64_t advance(std::uint16_t raw, double expected) const;
  void accept(std::uint16_t raw) { last_ = raw; }
  std::uint16_t last() const { return last_; }

 private:
  std::uint16_t last_ = 0;
};

/// Relation of a device's stamp to the stamps before it.
enum class StampKind {
  next,      ///< later than all before it
  repeated,  ///< the same once more, or out of order: of no use
  reset,     ///< the device's clock began anew, or jumped: nothing connects it to the stamps before it
  returned,  ///< connects to the stamps before the last one, whose reset was none: that one was damaged
};

/// Gap of the unwrapped time at a reset, so that times before and after it are never mistaken for one
/// another, nor a scan's stamp for one before the reset of its transmission.
inline constexpr std::int64_t kResetGap_us = 2'000'000;

/// Unwraps the 32-bit microsecond clock of a device (a wrap every 71.6 minutes) with the help of the hub's
/// time: a wrap, several wraps in a gap, and a power cycle are indistinguishable in the counter alone.
///
/// Three clocks vote: the device's, the hub's (late by up to half a minute when the network stalls), and the
/// count of telegrams. A stamp is a reset when the device's clock goes back, or when it agrees with neither
/// of the others, or when those two agree with one another against it.
class TimeUnwrapper {
 public:
  struct Unwrapped {
    StampKind kind = StampKind::next;
    std::int64_t device_us =
        0;  ///< [µs] ascending; after a reset it goes on by the hub's time and kResetGap_us
  };

  /// @param device the rig's name of the device, for errors
  explicit TimeUnwrapper(std::string device) : device_(std::move(device)) {}

  /// @param raw_us      [µs] the device's clock, modulo 2³²
  /// @param receipt_ns  [ns] the hub's clock
  /// @param counted_s   [s] time since the stamp before it by the count of telegrams and their rate, if known
  /// @throws Error if the clock wraps every second: the second of a stamp is then ambiguous
  Unwrapped add(std::uint32_t raw_us, std::int64_t receipt_ns,
                std::optional<double> counted_s = std::nullopt);

 private:
  struct State {
    DeviceStamp stamp;
    std::int64_t device_us = 0;  ///< unwrapped
  };
  static StampKind judge(const ElapsedTime& step, std::optional<double> counted_s);
  void refuse_seconds_clock(std::uint32_t raw_us);

  std::string device_;
  std::optional<State> last_;
  std::optional<State> before_reset_;  ///< while the reset hangs on one stamp
  std::uint32_t largest_raw_us_ = 0;
  int falls_ = 0;  ///< how often the counter fell back
};

}  // namespace crisp::clocks
