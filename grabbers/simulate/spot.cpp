// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/spot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace crisp::simulate {
namespace {

constexpr int kAround = 6;

/// Distance of the outer parts' centres of mass, for seven parts of equal area of a disk of diameter 1, a
/// middle one and six around it: the middle one has a radius of √(1/7) / 2, and a sector of 60° from there to
/// 1/2 its centre at 2/3 (R³ − r³) / (R² − r²) · sin 30° / (π/6).
constexpr double kOut = 0.3513;

/// Lambert's echo fades with the square of the range from 10 m on.
double strength(double reflectance, const Hit& hit) {
  constexpr double kFade = 10;
  const double share = hit.distance / kFade;
  return reflectance * hit.cos_incidence / (1 + share * share);
}

/// The strengths' sum and the distance that they make together.
SpotEcho together(std::span<const SpotEcho> echoes) {
  SpotEcho result{.hit = std::ranges::max_element(echoes, {}, &SpotEcho::strength)->hit};
  double distance = 0;
  for (const auto& echo : echoes) {
    result.strength += echo.strength;
    distance += echo.strength * echo.hit.distance;
  }
  if (result.strength > 0) result.hit.distance = distance / result.strength;
  return result;
}

/// The strongest of the echoes, sorted by distance, that gaps wider than `merge` separate.
SpotEcho strongest(std::span<const SpotEcho> echoes, double merge) {
  std::optional<SpotEcho> best;
  for (std::size_t begin = 0; begin < echoes.size();) {
    std::size_t end = begin + 1;
    while (end < echoes.size() && echoes[end].hit.distance - echoes[end - 1].hit.distance <= merge) ++end;
    const SpotEcho echo = together(echoes.subspan(begin, end - begin));
    if (!best || echo.strength > best->strength) best = echo;
    begin = end;
  }
  return *best;
}

}  // namespace

Spot::Spot(const NoiseEffects& effects, double max_distance, std::vector<double> reflectances)
    : divergence_(effects.divergence),
      aperture_(effects.aperture),
      merge_(effects.merge),
      max_distance_(max_distance),
      reflectances_(std::move(reflectances)) {}

std::optional<SpotEcho> Spot::thin(const RayCaster& scene, const Ray& ray, const Shot& shot) const {
  const auto hit = scene.cast(ray, max_distance_, shot);
  if (!hit) return std::nullopt;
  return SpotEcho{.hit = *hit, .strength = strength(reflectances_[hit->surface], *hit)};
}

std::optional<SpotEcho> Spot::echo(const RayCaster& scene, const Ray& beam, const Shot& shot) const {
  const auto middle = thin(scene, beam, shot);
  if (divergence_ == 0 && aperture_ == 0) return middle;
  std::array<SpotEcho, kAround + 1> echoes;
  std::size_t heard = 0;
  if (middle) echoes[heard++] = *middle;
  const Eigen::Vector3d u = beam.direction.unitOrthogonal();
  const Eigen::Vector3d v = beam.direction.cross(u);
  bool mixed = !middle;
  for (int k = 0; k < kAround; ++k) {
    const double angle = k * 2 * std::numbers::pi / kAround;
    const Eigen::Vector3d out = kOut * (std::cos(angle) * u + std::sin(angle) * v);
    auto part = thin(scene,
                     {.origin = beam.origin + aperture_ * out,
                      .direction = (beam.direction + divergence_ * out).normalized()},
                     shot);
    const bool same = part && middle && part->hit.surface == middle->hit.surface;
    if (same) part->hit.distance = middle->hit.distance;
    if (part) echoes[heard++] = *part;
    mixed = mixed || !same;
  }
  if (heard == 0) return std::nullopt;
  if (!mixed) return middle;
  const std::span<SpotEcho> all(echoes.data(), heard);
  std::ranges::stable_sort(all, {}, [](const SpotEcho& echo) { return echo.hit.distance; });
  SpotEcho result = strongest(all, merge_);
  result.strength /= kAround + 1;
  return result;
}

}  // namespace crisp::simulate
