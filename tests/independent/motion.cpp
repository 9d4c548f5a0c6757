// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace independent {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kGrid = 0.5e-3;  // [s] step of the grid: far finer than any law's change
constexpr double kMargin = 0.5;   // [s] that a motion is known before and after the capture

class Random {
 public:
  explicit Random(std::mt19937_64& engine) : engine_(engine) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  double logarithmic(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
  double sign() { return (*this)(-1, 1) < 0 ? -1 : 1; }

 private:
  std::mt19937_64& engine_;
};

/// A smooth function within −1 to 1: sines of random periods and phases.
std::function<double(double)> draw_waves(Random& random, int count, double shortest, double longest) {
  struct Wave {
    double share, pulsation, phase;
  };
  std::vector<Wave> waves;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    waves.push_back({random(0.3, 1), kTurn / random.logarithmic(shortest, longest), random(0, kTurn)});
    sum += waves.back().share;
  }
  for (auto& wave : waves) wave.share /= sum;
  return [waves](double t) {
    double value = 0;
    for (const auto& wave : waves) value += wave.share * std::sin(wave.pulsation * t + wave.phase);
    return value;
  };
}

/// Speed between two rates, evenly often slow and fast on a logarithmic scale.
std::function<double(double)> varied(Random& random) {
  const double low = random.logarithmic(0.1, 1.0), high = std::min(2.0, low * random.logarithmic(1.4, 6));
  const double sense = random.sign();
  const auto waves = draw_waves(random, 4, 1.5, 15);
  return [=](double t) {
    const double share = 0.5 + 0.5 * std::tanh(2 * waves(t)) / std::tanh(2);
    return kTurn * sense * low * std::pow(high / low, share);
  };
}

std::function<double(double)> reversal(Random& random) {
  const double peak = random.logarithmic(0.25, 1.5), pulsation = kTurn / random(3, 10),
               phase = random(0, kTurn);
  const auto waves = draw_waves(random, 2, 1.5, 6);
  return [=](double t) { return kTurn * peak * (0.8 * std::sin(pulsation * t + phase) + 0.2 * waves(t)); };
}

/// Stretches of constant speed and of standstill, with ramps of a fifth-order smooth step between them.
std::function<double(double)> stop_and_go(Random& random, double duration) {
  struct Ramp {
    double begin, length, from, to;
  };
  std::vector<Ramp> ramps;
  const double sense = random.sign();
  double time = -kMargin - random(0, 3), rate = 0;
  while (time < duration + kMargin) {
    const double next = rate == 0 ? sense * random.logarithmic(0.2, 1.5) : 0;
    ramps.push_back({time, random(0.25, 0.9), rate, next});
    rate = next;
    time += ramps.back().length + (rate == 0 ? random(0.4, 2) : random(1, 4));
  }
  return [ramps](double t) {
    const auto after =
        std::upper_bound(ramps.begin(), ramps.end(), t, [](double v, const Ramp& r) { return v < r.begin; });
    if (after == ramps.begin()) return 0.0;
    const Ramp& ramp = *std::prev(after);
    const double s = std::clamp((t - ramp.begin) / ramp.length, 0.0, 1.0);
    return kTurn * (ramp.from + (ramp.to - ramp.from) * s * s * s * (10 + s * (6 * s - 15)));
  };
}

std::function<double(double)> ripple(Random& random, double size) {
  const double rate = random.sign() * random.logarithmic(0.2, 1.5);
  const auto waves = draw_waves(random, 3, 0.7, 6);
  return [=](double t) { return kTurn * rate * (1 + size * waves(t)); };
}

}  // namespace

PlateMotion::PlateMotion(const std::function<double(double)>& rate, double begin, double end)
    : begin_(begin) {
  const auto nodes = static_cast<std::size_t>((end - begin) / kGrid) + 2;
  double angle = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double t = begin + kGrid * static_cast<double>(i);
    angles_.push_back(angle);
    rates_.push_back(rate(t));
    angle += kGrid / 6 * (rates_.back() + 4 * rate(t + kGrid / 2) + rate(t + kGrid));  // Simpson's rule
  }
}

double PlateMotion::angle(double time) const {
  const double at = std::clamp((time - begin_) / kGrid, 0.0, static_cast<double>(angles_.size()) - 1.001);
  const auto i = static_cast<std::size_t>(at);
  const double s = at - static_cast<double>(i), rest = 1 - s;  // cubic Hermite interpolation
  return rest * rest * ((1 + 2 * s) * angles_[i] + kGrid * s * rates_[i]) +
         s * s * ((1 + 2 * rest) * angles_[i + 1] - kGrid * rest * rates_[i + 1]);
}

double PlateMotion::range() const {
  const auto [low, high] = std::minmax_element(angles_.begin(), angles_.end());
  return *high - *low;
}

double PlateMotion::slowest() const {
  double least = std::abs(rates_.front());
  for (const double rate : rates_) least = std::min(least, std::abs(rate));
  return least;
}

double PlateMotion::fastest() const {
  double most = 0;
  for (const double rate : rates_) most = std::max(most, std::abs(rate));
  return most;
}

PlateMotion draw_motion(const std::string& name, double duration, std::mt19937_64 engine) {
  Random random(engine);
  const auto draw = [&]() -> std::function<double(double)> {
    if (name == "varied") return varied(random);
    if (name == "reversal") return reversal(random);
    if (name == "stop_and_go") return stop_and_go(random, duration);
    if (name == "ripple") return ripple(random, random(0.01, 0.05));
    if (name == "constant") return ripple(random, 0);
    throw std::runtime_error("motion " + name + " is unknown");
  };
  const double enough = kTurn * (name == "reversal" ? 0.75 : 1.25);
  std::optional<PlateMotion> motion;
  for (int attempt = 0; attempt < 100 && (!motion || motion->range() < enough); ++attempt) {
    motion.emplace(draw(), -kMargin, duration + kMargin);
  }
  return *motion;
}

}  // namespace independent
