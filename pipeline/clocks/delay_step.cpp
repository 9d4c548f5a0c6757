// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/delay_step.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/clocks/envelope.hpp"
#include "pipeline/clocks/lower_hull.hpp"
#include "pipeline/clocks/series.hpp"

namespace crisp::clocks {
namespace {

constexpr std::size_t kMinStampsOfAStep = 96;  // stamps: eight stretches of the envelope
constexpr Eigen::Index kMargin = 2;            // stretches that a level rests on at least
constexpr double kSmallest = 0.1e-3;  // [s] what is less bends no line by as much as lags are known to
constexpr double kStandsOut = 8;      // standard errors
constexpr double kAboveScatter = 4;   // times the envelope's own

/// Stamps of which a line lies below.
class Side {
 public:
  explicit Side(std::span<const Stamp> stamps) : stamps_(stamps) {
    for (const Stamp& s : stamps) {
      hull_.add(s);
      mean_ += s.device / static_cast<double>(stamps.size());
    }
  }
  const Stamp& lowest(double slope) const {
    return *std::ranges::min_element(hull_.vertices(), {},
                                     [&](const Stamp& s) { return s.lead - slope * s.device; });
  }
  /// Derivative of the sum of the line's heights at the stamps by its slope.
  double pull(double slope) const {
    return static_cast<double>(stamps_.size()) * (mean_ - lowest(slope).device);
  }
  ClockLine line(double slope) const {
    const Stamp& touched = lowest(slope);
    return {.center = mean_, .at_center = touched.lead + slope * (mean_ - touched.device), .slope = slope};
  }
  double std_error(double slope) const { return errors_of_line(stamps_, line(slope)).at_center; }

 private:
  std::span<const Stamp> stamps_;
  LowerHull hull_;
  double mean_ = 0;
};

/// The slope of parallel lines whose heights at the stamps have the greatest sum. It is concave in the slope:
/// where it is greatest, the pull changes sign.
double common_slope(const Side& before, const Side& after) {
  double low = -kMaxSkew;
  double high = kMaxSkew;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double slope = 0.5 * (low + high);
    (before.pull(slope) + after.pull(slope) > 0 ? low : high) = slope;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::optional<DelayStep> step_of_delay(std::span<const Stamp> stamps) {
  if (stamps.size() < kMinStampsOfAStep) return std::nullopt;
  const Envelope envelope = envelope_of(stamps);
  const Eigen::MatrixXd base = envelope.straight();
  const Eigen::MatrixXd tried = bend_and_steps(envelope.time, kMargin);
  const SeriesFit fit = best_in_series(base, tried, envelope.lead);
  const double size = fit.values[2];
  if (fit.column == 0 ||
      std::abs(size) < std::max({kSmallest, kStandsOut * fit.errors[2], kAboveScatter * fit.rms})) {
    return std::nullopt;
  }
  const auto stretch = static_cast<std::size_t>(before_step(tried.col(fit.column)));
  DelayStep step{.from = envelope.first[stretch - 1],
                 .to = envelope.first[std::min(stretch + 1, envelope.stamp.size())]};
  const auto level = [&](double t) { return envelope.line(fit.values, t); };
  step.first = std::clamp(first_after(stamps, size, level), step.from, step.to);
  const Side before(stamps.first(step.from));
  const Side after(stamps.subspan(step.to));
  const double slope = common_slope(before, after);
  step.by = after.line(slope).lead(0) - before.line(slope).lead(0);
  step.std_error = std::hypot(before.std_error(slope), after.std_error(slope));
  // Where some stamps on either side lie on one line, it was a burst of late ones only.
  if (std::abs(step.by) < std::max(kSmallest, 0.5 * std::abs(size))) return std::nullopt;
  return step;
}

}  // namespace crisp::clocks
