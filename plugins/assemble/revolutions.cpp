// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <utility>

#include <crisp/revolutions.hpp>

namespace crisp {
namespace {

constexpr double kStraggling = 0.1;  // [s] by which a laser's scans may come after another's

void mark(std::vector<bool>& lasers, std::size_t laser) {
  if (lasers.size() <= laser) lasers.resize(laser + 1);
  lasers[laser] = true;
}

std::shared_ptr<Cloud> begin_cloud(const Cloud& like) {
  auto cloud = std::make_shared<Cloud>();
  cloud->header = like.header;
  return cloud;
}

}  // namespace

void Revolutions::add(const Cloud& points, const PlateTrajectory& plate) {
  if (points.empty()) return;
  if (!current_) {
    current_ = begin_cloud(points);
    begin_ = points.front().time;
  }
  for (const Point& point : points) add(point, plate);
  const bool late = end_ && points.back().time > *end_ + kStraggling;
  if (end_ && (late || others_follow())) give_current();
}

void Revolutions::add(const Point& point, const PlateTrajectory& plate) {
  if (!end_ && ends_at(point.time, plate)) {
    end_ = point.time;
    next_ = begin_cloud(*current_);
  }
  const bool goes_on = end_ && point.time >= *end_;
  mark(goes_on ? gone_on_ : seen_, point.laser);
  (goes_on ? next_ : current_)->push_back(point);
}

bool Revolutions::ends_at(double time, const PlateTrajectory& plate) {
  const auto state = plate.at(time);
  if (state && !begin_angle_) begin_angle_ = state->angle;
  const double turned = state ? state->angle - *begin_angle_ : 0;
  const double whole = 2 * std::numbers::pi * settings_.turns;
  if (std::abs(turned) >= whole) {
    end_angle_ = *begin_angle_ + std::copysign(whole, turned);
    return true;
  }
  if (time - begin_ < settings_.longest) return false;
  end_angle_ = state ? state->angle : begin_angle_.value_or(0);
  return true;
}

/// Whether all lasers that are in the current cloud are in the next one, too.
bool Revolutions::others_follow() const {
  for (std::size_t laser = 0; laser < seen_.size(); ++laser) {
    if (seen_[laser] && (laser >= gone_on_.size() || !gone_on_[laser])) return false;
  }
  return true;
}

void Revolutions::give_current() {
  begin_ = *std::exchange(end_, std::nullopt);
  begin_angle_ = end_angle_;
  seen_ = std::exchange(gone_on_, {});
  const auto done = std::exchange(current_, std::exchange(next_, nullptr));
  if (!done->empty()) give_(done);
}

void Revolutions::finish() {
  if (end_) give_current();
  if (current_ && !current_->empty()) give_(std::exchange(current_, nullptr));
}

}  // namespace crisp
