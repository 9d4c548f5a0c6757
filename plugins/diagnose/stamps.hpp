// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/clocks/clock_line.hpp"
#include "pipeline/data/findings.hpp"

namespace crisp {

inline constexpr double kStampQuantum = 1e-6;  ///< [s] in which devices tell their time

/// One telegram: when its device says that it was sent, when the hub received it, and which it was.
struct CountedStamp {
  std::int64_t count = 0;  ///< of the device's counter, unwrapped
  Stamp stamp;             ///< device time since the first stamp, and by how much later it came in
};

/// The stamps of one device as they come in, with counter and clock unwrapped. A clock that jumps is
/// followed: its lead jumps.
class StampTrack {
 public:
  /// @param counter    wraps at 65536
  /// @param device_us  [µs] wraps at 2³²
  /// @param receipt_ns [ns]
  void add(std::uint16_t counter, std::uint32_t device_us, std::int64_t receipt_ns);
  std::span<const CountedStamp> stamps() const { return stamps_; }
  std::int64_t first_ns() const { return first_ns_; }  ///< [ns] receipt of the first

 private:
  std::vector<CountedStamp> stamps_;
  std::uint16_t last_counter_ = 0;
  std::uint32_t last_us_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::int64_t device_us_ = 0;  // since the first
};

/// A way in which a clock or its link is not what a straight line above constant shortest delay describes.
struct ClockDeparture {
  /// A backlog: telegrams that wait, and come in less and less late until all have been handed on.
  enum class Kind { drift, clock_step, latency_step, backlog };
  Kind kind = Kind::drift;
  double size = 0;       ///< drift: [1/s] of the skew; steps: [s] forwards, or later; backlog: [s] RMS
  double std_error = 0;  ///< of it
  double skew = 0;       ///< at the first stamp
  double skew_std_error = 0;
  double at = 0;  ///< [s] of the steps: receipt of the first stamp after it, less what delayed it, since the
                  ///< first of all
  double at_std_error = 0;  ///< [s]
  double p_value = 1;       ///< by permutations of the least delays
  Gain gain;                ///< RMS of held-out least delays about the clock

  struct Rival {
    std::optional<Kind> kind;  ///< nothing: a steady clock
    double log10_odds = 0;     ///< against it
  };
  /// What else could have made the least delays what they are, the likeliest first. Odds are by BIC (of a
  /// normal law of the least delays), between the steps of a clock and of a link by the device's own time:
  /// see log10_odds_of_jump(). Of a backlog, which has no name, there are none.
  std::vector<Rival> rivals = {};

  bool is_step() const { return kind == Kind::clock_step || kind == Kind::latency_step; }
};

/// What is usual of a device's clock and link; kUnasked where there are too few stamps to say.
struct ClockFacts {
  double skew = kUnasked;  ///< hub seconds a device second − 1
  double skew_std_error = kUnasked;
  double delay_median = kUnasked;  ///< [s] beyond the shortest
  double delay_95 = kUnasked;      ///< [s]
};

inline constexpr std::size_t kFewestOfClock = 10;  ///< stamps that say anything of a clock

ClockFacts clock_facts(std::span<const CountedStamp> stamps);

/// Looks at the lower envelope of receipt minus device time: at the least delay in each of up to 64 windows.
/// A step is one of the device's clock where the time between two counts jumps with it, and else one of the
/// link.
///
/// @param looks  so many devices are looked at; the p-value is corrected for them
/// @return  the most significant departure, if there is one beyond 0.002
std::optional<ClockDeparture> clock_departure(std::span<const CountedStamp> stamps, std::size_t looks,
                                              std::uint64_t seed);

/// The stamps as they were without a step, of the clock or of the link. A drift is left in them.
///
/// @param departure  with its instant since the first stamp
std::vector<CountedStamp> without_step(std::span<const CountedStamp> stamps, const ClockDeparture& departure);

/// The straight line below all stamps (convex hull), whatever their order.
ClockLine line_of(std::vector<Stamp> stamps);

/// Without their counts.
std::vector<Stamp> bare(std::span<const CountedStamp> stamps);

inline constexpr std::size_t kTurnsOfPiece = 8;  ///< that a mirror's period is taken over

/// How a mirror turns by its own stamps.
struct MirrorFacts {
  double period = 0;  ///< [s] mean, on the device's clock
  double period_std_error = 0;
  double wander = 0;            ///< RMS of the period's slow changes, as a share of it
  std::vector<double> periods;  ///< [s] of pieces of eight turns
  std::vector<double> begin;    ///< [s since the first telegram] of these pieces
};

/// Passes between which the device's clock went on as the mirror turned: none is across a restart, or across
/// a step of that clock.
///
/// @param unsure  [s] receipts from … to: the clock stepped somewhere between them
std::vector<std::span<const CountedStamp>> unbroken(std::span<const CountedStamp> passes,
                                                    const std::optional<std::array<double, 2>>& unsure = {});

/// Where the device's clock stepped; nothing if it did not.
std::optional<std::array<double, 2>> unsure_about(const std::optional<ClockDeparture>& departure);

/// @param passes  when the mirror passed its index, with the turn that it was; those across a break are
///                passed over
/// @return  nothing for fewer than eight pieces: from them no spread is known
std::optional<MirrorFacts> mirror_facts(std::span<const CountedStamp> passes,
                                        const std::optional<std::array<double, 2>>& unsure = {});

/// The same on the hub's clock, as far as that tells the device's: quartzes differ by as much as mirrors may.
MirrorFacts on_hubs_clock(MirrorFacts facts, const ClockFacts& clock);

/// What it brings for every other piece's period to expect that of the others in place of the nominal one
/// [s].
Gain gain_over_nominal(const MirrorFacts& facts, double nominal, std::uint64_t seed);

}  // namespace crisp
