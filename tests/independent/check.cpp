// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "tests/independent/decode.hpp"
#include "tests/independent/scanner.hpp"

namespace independent {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// The values of a counter of 32 bits without its wraps.
std::vector<double> unwrapped(const std::vector<std::uint32_t>& raw) {
  std::vector<double> values;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    values.push_back(i == 0 ? raw[0] : values.back() + static_cast<std::int32_t>(raw[i] - raw[i - 1]));
  }
  return values;
}

/// Hub time = device time · slope + start: the line below all (device, hub) that is nearest to them in the
/// middle.
struct ClockLine {
  double slope = 1, start = 0;
  double operator()(double device) const { return slope * device + start; }
};

ClockLine lower_envelope(const std::vector<double>& device, const std::vector<double>& hub) {
  std::vector<std::size_t> hull;  // the lower convex hull (monotone chain)
  const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    return (device[b] - device[a]) * ((hub[c] - device[c]) - (hub[a] - device[a])) -
           ((hub[b] - device[b]) - (hub[a] - device[a])) * (device[c] - device[a]);
  };
  for (std::size_t i = 0; i < device.size(); ++i) {
    while (hull.size() > 1 && turn(hull[hull.size() - 2], hull.back(), i) <= 0) hull.pop_back();
    hull.push_back(i);
  }
  double middle = 0;
  for (const double d : device) middle += d / static_cast<double>(device.size());
  std::size_t edge = 1;
  while (edge + 1 < hull.size() && device[hull[edge]] < middle) ++edge;
  const std::size_t a = hull.at(edge - 1), b = hull.at(edge);
  const double slope = (hub[b] - hub[a]) / (device[b] - device[a]);
  return {slope, hub[a] - slope * device[a]};
}

/// The plate's angle on the hub's clock, by cubic Lagrange interpolation of the encoder readings.
class EncoderAngle {
 public:
  EncoderAngle(const Setup& setup, const std::vector<DecodedReading>& readings) {
    std::vector<std::uint32_t> device, counts;
    std::vector<double> receipts;
    for (const auto& reading : readings) {
      device.push_back(reading.device_us);
      counts.push_back(reading.count);
      receipts.push_back(reading.receipt);
    }
    times_ = unwrapped(device);
    for (auto& time : times_) time *= 1e-6;
    const ClockLine line = lower_envelope(times_, receipts);
    const double first_device = times_.front();
    const double sense = setup.plate.is_clockwise ? -1 : 1;
    const double first =
        static_cast<std::int32_t>(counts.front() - static_cast<std::uint32_t>(setup.plate.start_count));
    const auto steps = unwrapped(counts);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      double angle = sense * kTurn * (first + steps[i] - steps[0] + 0.5) / setup.plate.counts;
      const double since_begin = times_[i] - first_device;
      for (const auto& [begin, jump] : setup.plate.slips) angle -= since_begin >= begin ? jump : 0;
      angles_.push_back(angle);
      times_[i] = line(times_[i]);
    }
  }

  bool covers(double time) const { return time > times_[1] && time < times_[times_.size() - 2]; }
  double operator()(double time) const {
    const auto after =
        static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin());
    double angle = 0;
    for (std::size_t i = after - 2; i < after + 2; ++i) {
      double weight = 1;
      for (std::size_t k = after - 2; k < after + 2; ++k) {
        if (k != i) weight *= (time - times_[k]) / (times_[i] - times_[k]);
      }
      angle += weight * angles_[i];
    }
    return angle;
  }

 private:
  std::vector<double> times_, angles_;
};

Vector rz(double angle, Vector v) {
  return {std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y, v.z};
}
Vector ry_quarter(Vector v) { return {v.z, v.y, -v.x}; }

/// Equation (2): Rz(φ+λ) Tx(τ) Rz(α) Ry(π/2) [r cosθ, r sinθ, 0]ᵀ, in the scene's frame.
Vector place(const Pose& pose, const Geometry& g, double plate_angle, double theta, double range) {
  const Vector p = rz(
      plate_angle + g.lambda,
      Vector{g.tau, 0, 0} + rz(g.alpha, ry_quarter({range * std::cos(theta), range * std::sin(theta), 0})));
  return pose.origin + p.x * pose.axes.x + p.y * pose.axes.y + p.z * pose.axes.z;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Measured less true range of each beam with an echo, for a value of η.
std::vector<double> residuals(const Setup& setup, const LaserSetup& laser, const World& world,
                              const EncoderAngle& plate, const std::vector<DecodedScan>& scans, double eta) {
  std::vector<std::uint32_t> stamps, transmissions;
  std::vector<double> receipts, found;
  for (const auto& scan : scans) {
    stamps.push_back(scan.stamp_us);
    transmissions.push_back(scan.transmission_us);
    receipts.push_back(scan.receipt);
  }
  auto sent = unwrapped(transmissions);
  for (auto& time : sent) time *= 1e-6;
  const ClockLine line = lower_envelope(sent, receipts);
  const Pose pose = plate_pose(setup);
  for (std::size_t i = 5; i + 5 < scans.size(); ++i) {
    const auto turns = static_cast<std::uint16_t>(scans[i + 5].scan_counter - scans[i - 5].scan_counter);
    const double period =
        line.slope * 1e-6 * static_cast<std::int32_t>(stamps[i + 5] - stamps[i - 5]) / turns;
    const double stamp = line(sent[i] - 1e-6 * static_cast<std::int32_t>(transmissions[i] - stamps[i]));
    for (std::size_t k = i % 7; k < scans[i].ranges.size(); k += 7) {
      const double degrees = static_cast<double>(k) * laser.kind.step_deg, range = scans[i].ranges[k];
      const double time = stamp + eta + (laser.period_offset + degrees / 360) * period;
      if (range == 0 || !plate.covers(time)) continue;
      const double theta = (laser.kind.start_deg + degrees) * kTurn / 360 - laser.mount, angle = plate(time);
      const Vector from = place(pose, laser.truth, angle, theta, 0);
      const auto hit = world.cast(from, place(pose, laser.truth, angle, theta, 1) - from);
      found.push_back(hit ? range - hit->range : 10);
    }
  }
  return found;
}

double robust_sd(std::vector<double> values) {
  const double middle = median(values);
  for (auto& value : values) value = std::abs(value - middle);
  return 1.4826 * median(values);
}

Setup read_setup(const std::string& folder, World& world) {
  std::ifstream truth(folder + "/truth.yaml");
  std::string line, argument, seed;
  std::getline(truth, line);
  if (line.find('"') == std::string::npos)
    throw std::runtime_error(folder + "/truth.yaml names no arguments");
  std::istringstream arguments(line.substr(line.find('"') + 1, line.rfind('"') - line.find('"') - 1));
  arguments >> seed;
  std::map<std::string, std::string> fixed;
  while (arguments >> argument)
    fixed[argument.substr(0, argument.find('='))] = argument.substr(argument.find('=') + 1);
  Draws draws(std::stoull(seed), fixed);
  Setup setup = draw_setup(draws);
  world = build_scene(setup.scene, setup.height, draws.stream("scene.solids"));
  return setup;
}

}  // namespace

bool check(const std::string& folder) {
  World world;
  const Setup setup = read_setup(folder, world);
  const DecodedCapture capture = decode_capture(folder + "/capture.pcap");
  const EncoderAngle plate(setup, capture.readings);
  bool is_good = true;
  for (const auto& laser : setup.lasers) {
    const auto scans = capture.scans.find(laser.address + ":" + std::to_string(laser.port));
    if (scans == capture.scans.end()) {
      std::printf("%s: no scans%s\n", laser.name.c_str(), laser.is_silent ? " (its fault)" : "");
      is_good = is_good && laser.is_silent;
      continue;
    }
    const auto sd_at = [&](double shift) {
      return robust_sd(residuals(setup, laser, world, plate, scans->second, eta(setup, laser) + shift));
    };
    const auto found = residuals(setup, laser, world, plate, scans->second, eta(setup, laser));
    const double sd = robust_sd(found), quantization = 5 * kTurn / setup.plate.counts / std::sqrt(12);
    const double limit = 1.1 * std::hypot(laser.sigma, quantization) + 1e-3;
    std::printf(
        "%s: %zu scans, %zu beams checked, median residual %.2f mm, sd %.2f mm (noise %.2f mm), sd at eta -2 ms %.2f mm, +2 ms %.2f mm\n",
        laser.name.c_str(), scans->second.size(), found.size(), 1e3 * median(found), 1e3 * sd,
        1e3 * laser.sigma, 1e3 * sd_at(-2e-3), 1e3 * sd_at(2e-3));
    is_good = is_good && !found.empty() && sd < limit;
  }
  std::printf("%s\n", is_good ? "the capture agrees with its truth" : "the capture contradicts its truth");
  return is_good;
}

}  // namespace independent
