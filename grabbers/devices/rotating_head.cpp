// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/rotating_head.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace crisp::devices {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kHeld = 5;           // [s] of beams, from which a piece is handed out
constexpr double kMargin = 1;         // [s] by which pieces of the trajectory overlap, for lags
constexpr double kClosest = 50e-6;    // [s] between two azimuths: 0.2 degrees at 10 Hz
constexpr double kClearStep = 0.002;  // [rad] beyond any rounding of azimuths
constexpr double kClearlyOff = 0.02;  // [rad] more than any head turns between two azimuths of an instant

}  // namespace

void RotatingHead::add_azimuth(double time, double azimuth) {
  if (!times_.empty() && time < times_.back() + kClosest) {
    const double off = std::abs(std::remainder(azimuth - angles_.back(), kTurn));
    different_ += time > times_.back() - kClosest && off > kClearlyOff;
    return;
  }
  double angle = azimuth;
  if (!angles_.empty()) {
    const double step = std::remainder(azimuth - angles_.back(), kTurn);
    angle = angles_.back() + step;
    up_ += step > kClearStep;
    down_ += step < -kClearStep;
  }
  if (!first_) first_ = {time, angle};
  times_.push_back(time);
  angles_.push_back(angle);
  ++azimuths_;
}

void RotatingHead::add(Measurements beams) {
  if (beams.size() > 0) beams_.push_back(std::move(beams));
}

std::uint64_t RotatingHead::contradictions() const { return std::min(up_, down_) + different_; }

double RotatingHead::turns() const { return first_ ? std::abs(angles_.back() - first_->second) / kTurn : 0; }

double RotatingHead::duration() const { return first_ ? times_.back() - first_->first : 0; }

HeadPiece RotatingHead::take_until(double time) {
  HeadPiece piece{.plate = PlateTrajectory(epoch_ns_, times_, angles_, max_gap_), .beams = {}};
  const auto left =
      std::ranges::find_if(beams_, [&](const Measurements& beams) { return beams.time.back() > time; });
  piece.beams.assign(std::move_iterator(beams_.begin()), std::move_iterator(left));
  beams_.erase(beams_.begin(), left);
  // The last azimuth stays: the next one is continued from it.
  const auto n = std::min(std::ranges::lower_bound(times_, time - kMargin) - times_.begin(),
                          std::max<std::ptrdiff_t>(0, std::ssize(times_) - 1));
  times_.erase(times_.begin(), times_.begin() + n);
  angles_.erase(angles_.begin(), angles_.begin() + n);
  return piece;
}

std::optional<HeadPiece> RotatingHead::take_piece() {
  if (beams_.empty() || times_.empty() || times_.back() - beams_.front().time.front() < kHeld) return {};
  return take_until(times_.back() - kMargin);
}

HeadPiece RotatingHead::take_rest() { return take_until(std::numeric_limits<double>::infinity()); }

}  // namespace crisp::devices
