// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <crisp/clock_aligner.hpp>
#include <crisp/clock_map.hpp>

#include "pipeline/clocks/clock_line.hpp"
#include "pipeline/clocks/delay_step.hpp"
#include "pipeline/clocks/hub_deviation.hpp"
#include "pipeline/clocks/lower_hull.hpp"
#include "plugins/clock/delay_histogram.hpp"

namespace crisp::clock {

/// One device's clock, fitted window by window while its stamps come in: the map from device time to hub
/// time runs straight from the line of one window, at the window's middle, to that of the next.
///
/// A window's line lies below the stamps of the window, and below those outside it as far as the clock's
/// drift cannot explain them: a stamp that lies u outside bounds the line with a slack of bend/2 · u². So a
/// window that is full of late stamps does not lift the line.
///
/// A reset of the device begins a new segment, which has nothing in common with the one before it. Where the
/// shortest delay becomes another (see step_of_delay()), the clock goes on in one line, and what comes later
/// is taken to be as late as what came before.
class WindowedClockFit {
 public:
  /// @param bend [1/s] largest change of the clock's rate in a second
  WindowedClockFit(std::string device, double bend);

  /// @param device_us [µs] unwrapped device time, later than all before
  /// @param hub       [s since the epoch] receipt
  void add(std::int64_t device_us, double hub);
  /// The next stamp begins a new segment.
  void cut() { cut_ = true; }
  /// Removes the last stamp, unless it is settled.
  void drop_last();
  /// Removes the segment of the last stamp, which was its only one: it was damaged, not a reset.
  void drop_last_segment();

  /// Corrects the steps of the minimum delay among the stamps that are not settled.
  void take_out_steps();
  const std::vector<StampStep>& delay_steps() const { return delay_steps_; }

  /// The stamps that are not settled, of the longest stretch without a reset.
  std::vector<clocks::ReceivedStamp> unsettled() const;
  /// Corrects those stamps by the hub's deviation, and all later ones by its last value.
  void take_out(const clocks::HubDeviation& deviation);

  /// Uncertainty of the line of the window that ends at `end` [s since the epoch], in s; 0 if there are too
  /// few stamps for an estimate.
  double uncertainty(double end) const;
  /// Fits the window of all stamps received before `end` [s since the epoch] that are not settled, forgets
  /// what no later window needs, and carries the map on to the middle between `begin` and `end`.
  void settle(double begin, double end);
  /// No stamps come any more: carries the map on to its end.
  void finish();

  /// Instead of settling: makes the map the line of the last `window` seconds [s] of the segment's stamps,
  /// for a clock that is read while its stamps come in. To be called after each add(); O(1) on the average
  /// but for the hull's vertices.
  void follow(double window);
  /// [s] How long the segment is that is followed.
  double followed() const;

  /// Whether all stamps so far are settled.
  bool idle() const;
  /// The clock's map so far; nothing before the first line.
  const std::optional<ClockMap>& map() const { return map_; }
  const std::string& device() const { return device_; }
  /// Number of added stamps, less the removed ones.
  std::size_t stamps() const { return stamps_; }

 private:
  struct Knot {
    double device = 0;  ///< [s]
    double hub = 0;     ///< [s since the epoch]
    double rate = 1;
    clocks::LineErrors errors;
  };
  struct Segment {
    std::int64_t first_us = 0;
    double first_hub = 0;
    double last_device = 0;  ///< [s] of the last stamp, since the first
    double later = 0;        ///< [s] by which the shortest delay has grown: taken out of leads
    double later_error = 0;  ///< [s] standard error of that
    clocks::LowerHull hull;
    std::vector<clocks::Stamp> stamps;  ///< of the windows that are not yet settled
    std::optional<Knot> first_knot;
    std::optional<Knot> last_knot;
    bool followed = false;  ///< the map's last piece is its

    double device(double stamp_device) const { return 1e-6 * static_cast<double>(first_us) + stamp_device; }
    double hub(const clocks::Stamp& stamp) const { return first_hub + stamp.device + stamp.lead; }
  };
  struct WindowFit {
    std::vector<clocks::Stamp> stamps;
    clocks::ClockLine line;
    clocks::LineErrors errors;
  };

  static clocks::ClockLine line_of(const Segment& segment);
  static void forget_before(Segment& segment, double device);
  void take_out(Segment& segment, const clocks::DelayStep& step);
  void make_hull_anew(Segment& segment, double first) const;
  std::optional<WindowFit> fit(const Segment& segment, double end) const;
  void settle(Segment& segment, double begin, double end);
  void settle_all(Segment& segment);
  void carry_on(Segment& segment, const Knot& knot);
  void append_piece(const ClockPiece& piece);
  void close(Segment& segment);

  std::string device_;
  double bend_;
  bool cut_ = true;
  std::deque<Segment> segments_;
  std::size_t stamps_ = 0;
  double hub_ahead_ = 0;  ///< [s] of the hub's clock, of a steady one: taken out of what comes
  std::optional<ClockMap> map_;
  DelayHistogram delays_;
  std::vector<StampStep> delay_steps_;
  double fitted_time_ = 0;      ///< [s] spans of the closed segments
  double squared_errors_ = 0;   ///< [s²] sum of the squares of their skews' errors, times their spans
  double squared_offsets_ = 0;  ///< [s²] sum of the squares of the knots' errors
  std::size_t knots_ = 0;
};

}  // namespace crisp::clock
