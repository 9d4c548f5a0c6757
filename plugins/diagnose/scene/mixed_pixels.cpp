// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scene/mixed_pixels.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>
#include <map>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kOnSurface = 4;  // standard deviations
constexpr double kClear = 0.12;   // [m] minimum distance of a mixed pixel from both sides of an edge

class EdgeFinder {
 public:
  EdgeFinder(const Measurements& beams, const PointsView& points, const BeamAssociation& association,
             const PointDensity& density, double usual, const NoiseModel& noise)
      : beams_(beams),
        points_(points),
        met_(association),
        density_(density),
        near_(kOnSurface * usual),
        noise_(noise) {}

  bool is_on(std::size_t i) const {
    return met_.end[i] != kNoSurface && std::abs(double{met_.distance[i]}) < near_;
  }

  /// Whether the laser's noise next to the beam's surface could produce a mixed pixel.
  bool is_noisy(std::size_t i) const {
    constexpr double kMax = kClear / 4;  // [m] 4 σ errors are rare
    const model::EchoConditions echo{.range = double{beams_.range[i]},
                                     .cosine = double{met_.end_cosine[i]},
                                     .remission = double{beams_.remission[i]}};
    return model::deviation(noise_.size, echo) > kMax;
  }

  /// Index of the first beam on the far side if an edge begins at `i`; otherwise `i`.
  std::size_t far_side(std::size_t i) const {
    constexpr std::size_t kMaxBetween = 3;
    constexpr double kMinJump = 0.4, kMaxJump = 1.2;  // [m]
    for (std::size_t k = i + 1; k < beams_.size() && k <= i + 1 + kMaxBetween; ++k) {
      if (!are_neighbours(beams_, k - 1, k)) return i;
      if (!is_on(k)) continue;
      const double jump = std::abs(double{beams_.range[k]} - double{beams_.range[i]});
      return met_.end[k] != met_.end[i] && jump >= kMinJump && jump <= kMaxJump ? k : i;
    }
    return i;
  }

  /// Relative position of a mixed pixel between the near side (0) and the far side (1), if there is one.
  std::optional<double> in_the_air(std::size_t first, std::size_t last) const {
    const auto [low, high] = std::minmax({double{beams_.range[first]}, double{beams_.range[last]}});
    for (std::size_t k = first + 1; k < last; ++k) {
      const double range{beams_.range[k]};
      if (range > low + kClear && range < high - kClear && is_in_the_air(k, first)) {
        return (range - low) / (high - low);
      }
    }
    return std::nullopt;
  }

 private:
  /// Whether the point density at a beam's end is far below that at another beam's, for their distances.
  bool is_in_the_air(std::size_t beam, std::size_t on_surface) const {
    constexpr double kFewer = 0.3;
    const double farther = double{beams_.range[beam]} / double{beams_.range[on_surface]};
    const auto density = [this](std::size_t i) {
      return static_cast<double>(density_.about(points_.x[i], points_.y[i], points_.z[i]));
    };
    return density(beam) * farther * farther < kFewer * density(on_surface);
  }

  const Measurements& beams_;
  PointsView points_;
  const BeamAssociation& met_;
  const PointDensity& density_;
  double near_;
  const NoiseModel& noise_;
};

}  // namespace

std::size_t PointDensity::Hash::operator()(const Cell& cell) const {
  constexpr std::array<std::uint64_t, 3> kPrimes = {73'856'093, 19'349'663,
                                                    83'492'791};  // Teschner et al. 2003
  std::uint64_t hash = 0;
  for (std::size_t k = 0; k < cell.size(); ++k) hash ^= static_cast<std::uint64_t>(cell[k]) * kPrimes[k];
  return hash;
}

PointDensity::Cell PointDensity::cell_of(double x, double y, double z) {
  constexpr double kSide = 0.04;  // [m]
  const auto along = [](double at) { return static_cast<std::int64_t>(std::floor(at / kSide)); };
  return {along(x), along(y), along(z)};
}

PointDensity::PointDensity(const PointsView& points) {
  for (std::size_t i = 0; i < points.size(); ++i) ++counts_[cell_of(points.x[i], points.y[i], points.z[i])];
}

std::size_t PointDensity::about(double x, double y, double z) const {
  const Cell middle = cell_of(x, y, z);
  std::size_t sum = 0;
  for (const std::int64_t a : {-1, 0, 1}) {
    for (const std::int64_t b : {-1, 0, 1}) {
      for (const std::int64_t c : {-1, 0, 1}) {
        const auto found = counts_.find({middle[0] + a, middle[1] + b, middle[2] + c});
        sum += found == counts_.end() ? 0 : found->second;
      }
    }
  }
  return sum;
}

double Crossings::share() const {
  return mixed.empty()
             ? 0
             : static_cast<double>(std::ranges::count(mixed, true)) / static_cast<double>(mixed.size());
}

std::vector<Edge> Crossings::by_edge() const {
  std::map<std::size_t, Edge> all;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    all[edges[k]].crossings += 1;
    all[edges[k]].mixed += mixed[k] ? 1 : 0;
  }
  std::vector<Edge> list;
  for (const auto& [number, edge] : all) list.push_back(edge);
  return list;
}

double Crossings::median_share() const {
  std::vector<double> shares;
  for (const Edge& edge : by_edge())
    shares.insert(shares.end(), static_cast<std::size_t>(edge.crossings), edge.share());
  return shares.empty() ? 0 : statistics::median_in_place(shares);
}

Crossings crossings_of(std::size_t laser, const Measurements& beams, const PointsView& points,
                       const BeamAssociation& association, const PointDensity& density, double usual,
                       const NoiseModel& noise) {
  const EdgeFinder finder(beams, points, association, density, usual, noise);
  Crossings crossings;
  std::map<std::array<long, 3>, std::size_t> edges;
  for (std::size_t i = 0; i + 1 < beams.size(); ++i) {
    if (beams.laser[i] != laser || !finder.is_on(i)) continue;
    const std::size_t far = finder.far_side(i);
    if (far == i || finder.is_noisy(i) || finder.is_noisy(far)) continue;
    const auto place = finder.in_the_air(i, far);
    crossings.mixed.push_back(place.has_value());
    const std::size_t near = beams.range[i] < beams.range[far] ? i : far;
    constexpr double kEdge = 0.5;  // [m]
    const std::array<long, 3> cell = {std::lround(points.x[near] / kEdge),
                                      std::lround(points.y[near] / kEdge),
                                      std::lround(points.z[near] / kEdge)};
    crossings.edges.push_back(edges.try_emplace(cell, edges.size()).first->second);
    if (place) crossings.places.push_back(*place);
  }
  return crossings;
}

MixedShare mixed_share(std::span<const Edge> edges) {
  double crossings = 0;
  double mixed = 0;
  double squares = 0;
  for (const Edge& edge : edges) {
    crossings += edge.crossings;
    mixed += edge.mixed;
    squares += edge.crossings * edge.crossings;
  }
  if (!(crossings > 0)) return {};
  MixedShare share{.value = mixed / crossings, .degrees_of_freedom = crossings * crossings / squares - 1};
  double scatter = 0;
  for (const Edge& edge : edges) scatter += std::pow(edge.mixed - share.value * edge.crossings, 2);
  const auto count = static_cast<double>(edges.size());
  const double between = count > 1 ? scatter * count / (count - 1) : 0;
  const double within = share.value * (1 - share.value) * crossings;
  share.std_error = std::sqrt(std::max({between, within, 1.0})) / crossings;
  return share;
}

std::optional<Finding> mixed_pixels(const std::string& scope, const Crossings& crossings) {
  constexpr double kOfThinThings = 0.03;
  constexpr double kRare = 0.002;
  constexpr std::size_t kMin = 50;
  if (crossings.mixed.size() < kMin) return std::nullopt;
  const MixedShare share = mixed_share(crossings.by_edge());
  if (!(share.degrees_of_freedom > 0)) return std::nullopt;
  const double p = cdf(complement(boost::math::students_t(share.degrees_of_freedom),
                                  (share.value - kOfThinThings) / share.std_error));
  if (!(p < kRare) || crossings.median_share() <= kOfThinThings) return std::nullopt;
  return Finding{.cause = "noise.mixed_pixels",
                 .scope = scope,
                 .parameters = {{.name = "share_of_edges",
                                 .unit = "1",
                                 .value = share.value,
                                 .std_error = share.std_error,
                                 .free = true}},
                 .explained_fraction = kNotTested,
                 .p_value = p,
                 .confounded_with = {},
                 .gain = {},
                 .accepted = true};
}

}  // namespace crisp::diagnose
