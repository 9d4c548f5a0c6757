// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/scanner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace independent {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kGrazing = 0.02;        // cosine of incidence below which no echo returns
constexpr double kSpot = 0.3;            // [deg] between the two halves of a beam that meets an edge
constexpr double kStampJitter = 2e-6;    // [s] sd of the scan's time stamp
constexpr double kShortestWait = 50e-6;  // [s] from the index pulse to transmission, at least

/// Origin and direction of a beam in the scene.
///
/// capture.md's equation (2), on paper: Ry(90°) turns the unit's x axis (θ = 0) onto −z and leaves its y axis
/// (θ = 90°), so the scan plane holds −z and one horizontal vector. Rz(α), Tx(τ) and Rz(φ+λ) leave z alone:
/// the unit stands τ from the axis at azimuth ψ = φ + λ, and its horizontal vector is that of azimuth ψ + α +
/// 90°.
struct Ray {
  Vector origin, direction;
};

Ray fire(const Pose& pose, const Geometry& g, double plate_angle, double theta) {
  const double azimuth = plate_angle + g.lambda, heading = azimuth + g.alpha + kTurn / 4;
  const Vector outward = std::cos(azimuth) * pose.axes.x + std::sin(azimuth) * pose.axes.y;
  const Vector sideways = std::cos(heading) * pose.axes.x + std::sin(heading) * pose.axes.y;
  return {pose.origin + g.tau * outward, std::sin(theta) * sideways - std::cos(theta) * pose.axes.z};
}

class Sensor {
 public:
  Sensor(const LaserSetup& laser, const World& world, const Pose& pose, std::mt19937_64& random)
      : laser_(laser), world_(world), pose_(pose), random_(random) {}

  /// Measures along a beam: range [mm] or 0, and remission.
  std::pair<std::uint16_t, std::uint8_t> measure(double plate_angle, double theta) {
    const Ray ray = fire(pose_, laser_.truth, plate_angle, theta);
    const auto hit = world_.cast(ray.origin, ray.direction);
    if (!hit || hit->incidence < kGrazing) return {0, 0};
    double range = hit->range;
    if (laser_.mixed_pixels > 0) range = mix(range, plate_angle, theta);
    const double noisy = range + laser_.sigma * normal_(random_);
    if (noisy > laser_.max_range || noisy < 0.05) return {0, 0};
    const double received =
        254 * hit->reflectivity * (0.3 + 0.7 * hit->incidence) / (1 + 0.02 * range) + 3 * normal_(random_);
    return {static_cast<std::uint16_t>(std::lround(1000 * noisy)),
            static_cast<std::uint8_t>(std::lround(std::clamp(received, 1.0, 254.0)))};
  }

 private:
  double mix(double range, double plate_angle, double theta) {
    const Ray other = fire(pose_, laser_.truth, plate_angle, theta + kSpot / 360 * kTurn);
    const auto behind = world_.cast(other.origin, other.direction);
    if (!behind || std::abs(behind->range - range) < 0.1 || even_(random_) > laser_.mixed_pixels)
      return range;
    return range + even_(random_) * (behind->range - range);
  }

  const LaserSetup& laser_;
  const World& world_;
  Pose pose_;
  std::mt19937_64& random_;
  std::normal_distribution<> normal_;
  std::uniform_real_distribution<> even_;
};

}  // namespace

Mirror::Mirror(double nominal, double slowness, double wander, std::mt19937_64& random) {
  std::uniform_real_distribution<> share(0.2, 1), period(1.5, 9), phase(0, kTurn), start(0, 1);
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    waves_.push_back({share(random), kTurn / period(random), phase(random)});
    sum += waves_.back().size;
  }
  for (auto& wave : waves_) wave.size *= wander / sum;
  mean_ = nominal * (1 - slowness);
  start_ = start(random);
}

double Mirror::rate(double time) const {
  double relative = 1;
  for (const auto& wave : waves_) relative += wave.size * std::sin(wave.pulsation * time + wave.phase);
  return mean_ * relative;
}

double Mirror::turns(double time) const {
  double integral = time;
  for (const auto& w : waves_)
    integral += w.size / w.pulsation * (std::cos(w.phase) - std::cos(w.pulsation * time + w.phase));
  return start_ + mean_ * integral;
}

double Mirror::time_of(double requested) const {
  double time = (requested - start_) / mean_;
  for (int i = 0; i < 3; ++i) time += (requested - turns(time)) / rate(time);
  return time;
}

Pose plate_pose(const Setup& setup) {
  const Vector about{std::cos(setup.tilt_azimuth), std::sin(setup.tilt_azimuth), 0};
  return {{0, 0, setup.height}, rotated(turned_about_vertical(setup.yaw), about, setup.tilt)};
}

std::vector<Scan> simulate_scans(const Setup& setup, const LaserSetup& laser, const World& world,
                                 const PlateMotion& motion, std::mt19937_64 random) {
  const Mirror mirror(laser.kind.rate, laser.slowness, laser.wander, random);
  Sensor sensor(laser, world, plate_pose(setup), random);
  std::normal_distribution<> normal;
  std::vector<Scan> scans;
  // An index pulse ends each turn; the first beam that the device reports (−45° of 270°, −5° of 190°, 0° of
  // 360°) is fired at the pulse. The stamp is that pulse, or the one after the sweep in firmware that stamps
  // late.
  for (double turn = std::ceil(mirror.turns(0)); mirror.time_of(turn + 1) < setup.duration; ++turn) {
    Scan scan;
    const double pulse = mirror.time_of(turn), next_pulse = mirror.time_of(turn + 1);
    scan.stamp =
        (laser.period_offset == 0 ? pulse : next_pulse) - laser.stamp_offset + kStampJitter * normal(random);
    scan.transmission = next_pulse + std::max(kShortestWait, laser.processing + laser.kind.processing_jitter *
                                                                                    normal(random));
    for (int k = 0; k < laser.kind.beams; ++k) {
      const double degrees = k * laser.kind.step_deg;
      const double theta = (laser.kind.start_deg + degrees) / 360 * kTurn - laser.mount;
      const auto [range, remission] =
          sensor.measure(motion.angle(mirror.time_of(turn + degrees / 360)), theta);
      scan.ranges.push_back(range);
      scan.remissions.push_back(remission);
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

}  // namespace independent
