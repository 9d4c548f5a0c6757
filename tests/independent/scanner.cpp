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

Ray fire(const Pose& pose, const Geometry& g, double plate_angle, double theta, double elevation = 0,
         double tilt = 0) {
  const double azimuth = plate_angle + g.lambda, heading = azimuth + g.alpha + kTurn / 4;
  const Vector outward = std::cos(azimuth) * pose.axes.x + std::sin(azimuth) * pose.axes.y;
  const Vector sideways = std::cos(heading) * pose.axes.x + std::sin(heading) * pose.axes.y;
  const Vector normal = cross(-1.0 * pose.axes.z, sideways);
  const Vector down = std::sin(tilt) * normal - std::cos(tilt) * pose.axes.z;
  const Vector in_plane = std::sin(theta) * sideways + std::cos(theta) * down;
  const Vector off_plane = cross(down, sideways);
  return {pose.origin + g.tau * outward, std::cos(elevation) * in_plane + std::sin(elevation) * off_plane};
}

/// The mirror angle and elevation of a beam whose reported mirror angle is `theta`, with an effect.
Ray fire(const Pose& plain, const Geometry& geometry, const Effect& effect, bool acts, double time,
         double plate_angle, double theta) {
  const Pose pose = effect.pose ? effect.pose(plain, effect.size, time, plate_angle) : plain;
  const double turned = acts && effect.mirror ? effect.size * effect.mirror(theta) : 0;
  const double raised = acts && effect.elevation ? effect.size * effect.elevation(theta) : 0;
  const double tilt = acts ? effect.size * effect.tilt : 0;
  return fire(pose, geometry, plate_angle, theta + turned, raised, tilt);
}

double remission_of(const Hit& hit) {
  return 254 * hit.reflectivity * (0.3 + 0.7 * hit.incidence) / (1 + 0.02 * hit.range);
}

class Sensor {
 public:
  Sensor(const LaserSetup& laser, const World& world, const Pose& pose, const Effect& effect, bool acts,
         std::mt19937_64& random)
      : laser_(laser), world_(world), pose_(pose), effect_(effect), acts_(acts), random_(random) {}

  /// Measures along a beam: range [mm] or 0, and remission.
  std::pair<std::uint16_t, std::uint8_t> measure(double time, double plate_angle, double theta) {
    const Ray ray = fire(pose_, laser_.truth, effect_, acts_, time, plate_angle, theta);
    const auto hit = world_.cast(ray.origin, ray.direction);
    if (!hit || hit->incidence < kGrazing) return {0, 0};
    double range = hit->range;
    if (laser_.mixed_pixels > 0) range = mix(range, plate_angle, theta);
    if (acts_ && effect_.spot > 0) range = averaged(range, plate_angle, theta);
    double noisy = range + laser_.sigma * normal_(random_);
    const double received = remission_of({range, hit->incidence, hit->reflectivity}) + 3 * normal_(random_);
    const double remission = std::clamp(received, 1.0, 254.0);
    const Echo echo{range, hit->incidence, remission, time, theta};
    if (acts_ && effect_.range) noisy += effect_.size * effect_.range(echo);
    if (acts_ && effect_.noise) noisy += effect_.noise(echo, laser_.sigma, random_);
    if (noisy > laser_.max_range || noisy < 0.05) return {0, 0};
    return {static_cast<std::uint16_t>(std::lround(1000 * noisy)),
            static_cast<std::uint8_t>(std::lround(remission))};
  }

 private:
  double mix(double range, double plate_angle, double theta) {
    const Ray other = fire(pose_, laser_.truth, plate_angle, theta + kSpot / 360 * kTurn);
    const auto behind = world_.cast(other.origin, other.direction);
    if (!behind || std::abs(behind->range - range) < 0.1 || even_(random_) > laser_.mixed_pixels)
      return range;
    return range + even_(random_) * (behind->range - range);
  }

  /// A wide footprint: each half sees its own surface, and the range is a mean by the light of each.
  double averaged(double range, double plate_angle, double theta) {
    const double aside = effect_.spot / 4;
    const auto left = seen_along(fire(pose_, laser_.truth, plate_angle, theta - aside));
    const auto right = seen_along(fire(pose_, laser_.truth, plate_angle, theta + aside));
    if (!left || !right || std::abs(left->range - right->range) < 0.1) return range;
    const double a = remission_of(*left), b = remission_of(*right);
    return (a * left->range + b * right->range) / (a + b);
  }

  std::optional<Hit> seen_along(const Ray& ray) const { return world_.cast(ray.origin, ray.direction); }

  const LaserSetup& laser_;
  const World& world_;
  Pose pose_;
  const Effect& effect_;
  bool acts_;
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

std::vector<Scan> simulate_scans(const Setup& setup, std::size_t index, const World& world,
                                 const PlateMotion& motion, const Effect& effect, std::mt19937_64 random) {
  const LaserSetup& laser = setup.lasers[index];
  const Mirror mirror(laser.kind.rate, laser.slowness, laser.wander, random);
  Sensor sensor(laser, world, plate_pose(setup), effect, effect.acts_on(index), random);
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
      const double fired = mirror.time_of(turn + degrees / 360);
      const auto [range, remission] = sensor.measure(fired, motion.angle(fired), theta);
      scan.ranges.push_back(range);
      scan.remissions.push_back(remission);
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

double effect_rms(const Setup& setup, const World& world, const PlateMotion& motion, const Effect& effect,
                  std::mt19937_64 random) {
  constexpr int kBeams = 6000;
  constexpr double kEdge = 0.3;  // [m]
  const Pose plain = plate_pose(setup);
  std::uniform_real_distribution<> even;
  double squares = 0;
  int beams = 0;
  for (int i = 0; i < kBeams; ++i) {
    const std::size_t index = random() % setup.lasers.size();
    const LaserSetup& laser = setup.lasers[index];
    const bool acts = effect.acts_on(index);
    const double time = setup.duration * even(random);
    const double degrees = laser.kind.start_deg + even(random) * laser.kind.step_deg * laser.kind.beams;
    const double theta = degrees / 360 * kTurn - laser.mount;
    const Ray ray = fire(plain, laser.truth, effect, acts, time, motion.angle(time), theta);
    const double reported_time = time + (acts && effect.clock ? effect.size * effect.clock(time) : 0);
    const double reported_angle =
        motion.angle(reported_time) + (effect.encoder ? effect.size * effect.encoder(reported_time) : 0);
    const Ray expected = fire(plain, laser.truth, reported_angle, theta);
    const auto hit = world.cast(ray.origin, ray.direction);
    const auto other = world.cast(expected.origin, expected.direction);
    if (!acts || !hit || !other || hit->incidence < kGrazing) continue;
    const Echo echo{hit->range, hit->incidence, remission_of(*hit), time, theta};
    const double change = hit->range - other->range + (effect.range ? effect.size * effect.range(echo) : 0);
    if (std::abs(change) > kEdge) continue;
    squares += change * change;
    ++beams;
  }
  return beams > 0 ? std::sqrt(squares / beams) : 0;
}

}  // namespace independent
