// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/windowed_clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/clocks/unwrap.hpp"

namespace crisp::clock {
namespace {

using clocks::Stamp;

constexpr double kWindowsBack = 2;         // how many windows' stamps before a window bound its line
constexpr std::size_t kEnoughStamps = 64;  // to judge from them how far they are from the clock

/// The stamps of a window, between those outside it that may bound its line, raised by what the clock may
/// have drifted until then.
std::vector<Stamp> with_bounds(std::span<const Stamp> inside, std::span<const Stamp> hull, double bend) {
  const double first = inside.front().device;
  const double last = inside.back().device;
  const auto raised = [bend](Stamp stamp, double edge) {
    const double outside = stamp.device - edge;
    stamp.lead += 0.5 * bend * outside * outside;
    return stamp;
  };
  std::vector<Stamp> all;
  all.reserve(inside.size() + hull.size());
  for (const auto& stamp : hull) {
    if (stamp.device < first) all.push_back(raised(stamp, first));
  }
  all.insert(all.end(), inside.begin(), inside.end());
  for (const auto& stamp : hull) {
    if (stamp.device > last) all.push_back(raised(stamp, last));
  }
  return all;
}

double mean_device(std::span<const Stamp> stamps) {
  double sum = 0;
  for (const auto& stamp : stamps) sum += stamp.device - stamps.front().device;
  return stamps.front().device + sum / static_cast<double>(stamps.size());
}

}  // namespace

WindowedClockFit::WindowedClockFit(std::string device, double bend)
    : device_(std::move(device)), bend_(bend) {}

void WindowedClockFit::add(std::int64_t device_us, double hub) {
  hub -= hub_ahead_;
  if (cut_) {
    segments_.push_back({.first_us = device_us, .first_hub = hub, .hull = clocks::LowerHull(bend_)});
    cut_ = false;
  }
  Segment& segment = segments_.back();
  const double device = 1e-6 * static_cast<double>(device_us - segment.first_us);
  const Stamp stamp{.device = device, .lead = hub - segment.first_hub - device - segment.later};
  segment.hull.add(stamp);
  segment.stamps.push_back(stamp);
  segment.last_device = device;
  ++stamps_;
}

void WindowedClockFit::drop_last() {
  if (segments_.empty() || segments_.back().stamps.size() < 2) return;
  Segment& segment = segments_.back();
  const double first = segment.stamps.front().device;
  segment.stamps.pop_back();
  segment.last_device = segment.stamps.back().device;
  make_hull_anew(segment, first);
  --stamps_;
}

void WindowedClockFit::drop_last_segment() {
  if (segments_.size() < 2) {  // the one before is settled and gone
    cut();
    return;
  }
  stamps_ -= segments_.back().stamps.size();
  if (segments_.back().followed && map_ && !map_->pieces.drop_last()) map_.reset();
  segments_.pop_back();
}

void WindowedClockFit::follow(double window) {
  while (segments_.size() > 2) segments_.pop_front();  // the last may still turn out to be none
  Segment& segment = segments_.back();
  forget_before(segment, segment.last_device - window);
  const clocks::ClockLine line = line_of(segment);
  const bool is_first = !map_ || (segment.followed && map_->pieces.size() == 1);
  const double first = segment.device(0);
  const double begin = is_first ? first : first - 0.75e-6 * clocks::kResetGap_us;  // as in carry_on()
  const ClockPiece piece{.device_begin = begin,
                         .hub_begin = segment.first_hub + (begin - first) + line.lead(begin - first),
                         .rate = 1 + line.slope,
                         .rate_std_error = clocks::kMaxSkew};
  if (segment.followed) {
    map_->pieces.replace_last(piece);
  } else {
    append_piece(piece);
  }
  segment.followed = true;
  map_->device_end = segment.device(segment.last_device);
  const Stamp& latest = segment.stamps.back();
  delays_.add(std::abs(latest.lead - line.lead(latest.device)));
}

double WindowedClockFit::followed() const {
  return segments_.empty() || !segments_.back().followed ? 0 : segments_.back().last_device;
}

/// Forgets what a line of the stamps from `device` [s] on does not need: the hull keeps one vertex before.
void WindowedClockFit::forget_before(Segment& segment, double device) {
  const auto vertices = segment.hull.vertices();
  const auto inside =
      std::ranges::find_if(vertices, [&](const Stamp& vertex) { return vertex.device > device; });
  if (inside == vertices.begin()) return;
  const double first = std::prev(inside)->device;
  segment.hull.forget_before(first);
  auto& stamps = segment.stamps;
  const auto kept =
      std::ranges::partition_point(stamps, [&](const Stamp& stamp) { return stamp.device < first; });
  if (kept - stamps.begin() > stamps.end() - kept) stamps.erase(stamps.begin(), kept);
}

clocks::ClockLine WindowedClockFit::line_of(const Segment& segment) {
  const auto vertices = segment.hull.vertices();
  return clocks::line_by_convex_hull(vertices, 0.5 * (vertices.front().device + segment.last_device));
}

std::optional<WindowedClockFit::WindowFit> WindowedClockFit::fit(const Segment& segment, double end) const {
  WindowFit fit;
  for (const auto& stamp : segment.stamps) {
    if (segment.hub(stamp) < end) fit.stamps.push_back(stamp);
  }
  if (fit.stamps.empty()) return std::nullopt;
  fit.line = clocks::line_by_convex_hull(with_bounds(fit.stamps, segment.hull.vertices(), bend_),
                                         mean_device(fit.stamps));
  const double span = fit.stamps.back().device - fit.stamps.front().device;
  fit.errors = clocks::errors_of_line(fit.stamps, fit.line);
  fit.errors.at_center = std::hypot(fit.errors.at_center, segment.later_error);
  if (span > 0) fit.errors.slope = std::hypot(fit.errors.slope, segment.later_error / span);
  return fit;
}

std::vector<clocks::ReceivedStamp> WindowedClockFit::unsettled() const {
  std::vector<clocks::ReceivedStamp> stamps;
  const auto longest =
      std::ranges::max_element(segments_, {}, [](const Segment& segment) { return segment.stamps.size(); });
  if (longest == segments_.end()) return stamps;
  for (const Stamp& stamp : longest->stamps)
    stamps.push_back({.hub = longest->hub(stamp), .lead = stamp.lead});
  return stamps;
}

void WindowedClockFit::take_out(const clocks::HubDeviation& deviation) {
  for (Segment& segment : segments_) {
    if (segment.stamps.empty()) continue;
    const double first = segment.stamps.front().device;
    std::vector<Stamp> kept;
    for (Stamp stamp : segment.stamps) {
      const double hub = segment.hub(stamp);
      stamp.lead -= deviation.at(hub);
      if (!deviation.is_unsure(hub)) kept.push_back(stamp);
    }
    constexpr std::size_t kMin = 4;  // a stretch that is all unsure is kept as it is
    if (kept.size() < std::min(kMin, segment.stamps.size())) continue;
    segment.stamps = std::move(kept);
    make_hull_anew(segment, first);
  }
  hub_ahead_ += deviation.at_end();
}

void WindowedClockFit::take_out_steps() {
  constexpr int kMax = 8;  // a link that is so restless has no shortest delay
  for (auto& segment : segments_) {
    for (int n = 0; n < kMax; ++n) {
      const auto step = clocks::step_of_delay(segment.stamps);
      if (!step) break;
      take_out(segment, *step);
    }
  }
}

/// The usual part stays: for a segment without a line yet, the longer one.
void WindowedClockFit::take_out(Segment& segment, const clocks::DelayStep& step) {
  auto& stamps = segment.stamps;
  const auto at = [&](std::size_t i) { return stamps.begin() + static_cast<std::ptrdiff_t>(i); };
  const double first = stamps.front().device;
  const bool at_first = !segment.first_knot && step.first < stamps.size() / 2;
  delay_steps_.push_back({.at = segment.hub(stamps[step.first]) + segment.later, .by = step.by});
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (at_first && i < step.from) stamps[i].lead += step.by;
    if (!at_first && i >= step.to) stamps[i].lead -= step.by;
  }
  if (!at_first) segment.later += step.by;
  segment.later_error = std::hypot(segment.later_error, step.std_error);
  stamps.erase(at(step.from), at(step.to));  // on which side of it they were sent is not known
  make_hull_anew(segment, first);
}

/// From the stamps that are not settled, of which the first was at `first` [s], and what settled ones left.
void WindowedClockFit::make_hull_anew(Segment& segment, double first) const {
  clocks::LowerHull hull(bend_);
  for (const Stamp& vertex : segment.hull.vertices()) {
    if (vertex.device < first) hull.add(vertex);
  }
  for (const Stamp& stamp : segment.stamps) hull.add(stamp);
  segment.hull = std::move(hull);
}

double WindowedClockFit::uncertainty(double end) const {
  double uncertainty = 0;
  for (const auto& segment : segments_) {
    const auto window = fit(segment, end);
    if (window && window->stamps.size() >= kEnoughStamps)
      uncertainty = std::max(uncertainty, window->errors.at_center);
  }
  return uncertainty;
}

void WindowedClockFit::settle(double begin, double end) {
  for (auto& segment : segments_) {
    settle(segment, begin, end);
    const bool ended = &segment != &segments_.back();
    if (ended && segment.stamps.empty()) close(segment);
  }
  while (segments_.size() > 1 && segments_.front().stamps.empty()) segments_.pop_front();
}

void WindowedClockFit::settle(Segment& segment, double begin, double end) {
  const auto window = fit(segment, end);
  if (!window) return;
  const auto& [stamps, line, errors] = *window;
  for (const auto& stamp : stamps) delays_.add(std::abs(stamp.lead - line.lead(stamp.device)));
  // The map passes through the line at the window's middle, or as near to it as there are stamps.
  const double rate = 1 + line.slope;
  const double hub = std::clamp(0.5 * (begin + end), segment.hub(stamps.front()), segment.hub(stamps.back()));
  const double at_center = segment.first_hub + line.center + line.at_center - errors.bias;
  const double device = line.center + (hub - at_center) / rate;
  carry_on(segment, {.device = segment.device(device), .hub = hub, .rate = rate, .errors = errors});
  std::erase_if(segment.stamps, [&](const Stamp& stamp) { return segment.hub(stamp) < end; });
  segment.hull.forget_before(end - segment.first_hub - kWindowsBack * (end - begin));
}

/// For a segment whose receipts all lie ahead of the hub's latest time, once its deviation is taken out.
void WindowedClockFit::settle_all(Segment& segment) {
  if (segment.stamps.empty()) return;
  double latest = -std::numeric_limits<double>::infinity();
  for (const Stamp& stamp : segment.stamps) latest = std::max(latest, segment.hub(stamp));
  settle(segment, segment.hub(segment.stamps.front()),
         std::nextafter(latest, std::numeric_limits<double>::infinity()));
}

void WindowedClockFit::append_piece(const ClockPiece& piece) {
  if (!map_) {
    map_.emplace(ClockMap{.device = device_, .pieces = ClockPieces(piece)});
  } else if (piece.device_begin > map_->pieces.back().device_begin) {
    map_->pieces.append(piece);
  }
}

void WindowedClockFit::carry_on(Segment& segment, const Knot& knot) {
  if (!segment.first_knot) {
    // A scan's own stamp is earlier than its transmission's, which began the segment.
    const double begin = segment.device(0) - (map_ ? 0.75e-6 * clocks::kResetGap_us : 0);
    append_piece({.device_begin = begin,
                  .hub_begin = knot.hub - knot.rate * (knot.device - begin),
                  .rate = knot.rate,
                  .rate_std_error = knot.errors.slope});
    segment.first_knot = knot;
  } else {
    const Knot& before = *segment.last_knot;
    const double span = knot.device - before.device;
    if (!(span > 0)) return;  // receipts that went back in time
    append_piece({.device_begin = before.device,
                  .hub_begin = before.hub,
                  .rate = (knot.hub - before.hub) / span,
                  .rate_std_error = std::hypot(before.errors.at_center, knot.errors.at_center) / span});
  }
  segment.last_knot = knot;
  squared_offsets_ += knot.errors.at_center * knot.errors.at_center;
  ++knots_;
}

void WindowedClockFit::close(Segment& segment) {
  if (!segment.last_knot) return;
  const Knot& first = *segment.first_knot;
  const Knot& last = *segment.last_knot;
  double skew_error = last.errors.slope;
  if (last.device > first.device) {
    append_piece({.device_begin = last.device,
                  .hub_begin = last.hub,
                  .rate = last.rate,
                  .rate_std_error = last.errors.slope});
    skew_error = std::hypot(first.errors.at_center, last.errors.at_center) / (last.device - first.device);
  }
  map_->device_end = segment.device(segment.last_device);
  fitted_time_ += segment.last_device;
  squared_errors_ += std::pow(skew_error * segment.last_device, 2);
}

bool WindowedClockFit::idle() const {
  return std::all_of(segments_.begin(), segments_.end(), [](const Segment& s) { return s.stamps.empty(); });
}

void WindowedClockFit::finish() {
  std::optional<double> followed_error;
  if (map_ && !segments_.empty() && segments_.back().followed) {
    const clocks::LineErrors errors =
        clocks::errors_of_line(segments_.back().stamps, line_of(segments_.back()));
    followed_error = errors.slope;
    ClockPiece last = map_->pieces.back();
    last.rate_std_error = *followed_error;
    map_->pieces.replace_last(last);
    map_->std_error = std::hypot(errors.at_center, errors.bias);  // a clock that is followed lies on its line
  }
  for (auto& segment : segments_) {
    if (!segment.followed && !segment.first_knot) settle_all(segment);
    close(segment);
  }
  segments_.clear();
  cut_ = true;
  if (!map_) return;
  map_->skew_std_error = followed_error     ? *followed_error
                         : fitted_time_ > 0 ? std::sqrt(squared_errors_) / fitted_time_
                                            : clocks::kMaxSkew;
  if (knots_ > 0) map_->std_error = std::sqrt(squared_offsets_) / static_cast<double>(knots_);
  map_->residual_median = delays_.quantile(0.5);
  map_->residual_95 = delays_.quantile(0.95);
  map_->stamps = stamps_;
}

}  // namespace crisp::clock
