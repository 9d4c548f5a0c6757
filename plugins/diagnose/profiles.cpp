// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/profiles.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "plugins/diagnose/mean.hpp"

namespace crisp {
namespace {

constexpr std::size_t kBins = 12;
constexpr std::size_t kSimulations = 199;

/// The beams that count, surface by surface.
struct Residuals {
  std::vector<std::uint32_t> beam;
  std::vector<double> value;   // [m] along the beam
  std::vector<double> weight;  // 0 to 1
  std::vector<double> cosine;
  std::vector<Eigen::MatrixX3d> planes;  // of each surface: what its plane can take, orthonormal
  std::vector<std::size_t> first;        // beam of each surface; one more than there are
};

/// Orthonormal columns that span what a surface's plane can do to its weighted residuals.
Eigen::MatrixX3d span_of_plane(const std::vector<SurfelResidual>& residuals) {
  Eigen::MatrixX3d basis(static_cast<Eigen::Index>(residuals.size()), 3);
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const SurfelResidual& r = residuals[k];
    basis.row(static_cast<Eigen::Index>(k)) =
        Eigen::RowVector3d(1, r.u, r.v) * (std::sqrt(r.weight) / std::max(0.05, std::abs(r.incidence)));
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> qr(basis);
  Eigen::MatrixX3d span = qr.householderQ() * Eigen::MatrixX3d::Identity(basis.rows(), 3);
  span.rightCols(3 - std::min<Eigen::Index>(3, qr.rank())).setZero();
  return span;
}

Residuals residuals_in(const Evidence& evidence, const SurfelSettings& settings) {
  Residuals all;
  for (const Surfel& surfel : evidence.surfels().surfels) {
    std::vector<SurfelResidual> counting;
    const auto members = evidence.surfels().beams_of(surfel);
    const auto residuals = residuals_of(surfel, evidence.surfels(), evidence.beams(), settings);
    all.first.push_back(all.beam.size());
    for (std::size_t k = 0; k < residuals.size(); ++k) {
      const SurfelResidual& r = residuals[k];
      if (r.weight == 0) continue;
      counting.push_back(r);
      all.beam.push_back(members[k]);
      all.value.push_back(-r.range_change);
      all.weight.push_back(r.weight);
      all.cosine.push_back(std::abs(r.incidence));
    }
    all.planes.push_back(span_of_plane(counting));
  }
  all.first.push_back(all.beam.size());
  return all;
}

/// [m] Standard deviation of each laser's ranges, from differences of neighbours: beams of one scan on one
/// surface. Lasers that disagree, and whatever else changes slowly, are not in it. Where there are hardly any
/// neighbours, from all residuals.
std::vector<double> noise_of(const Residuals& residuals, const Measurements& beams) {
  constexpr double kOneScan = 0.005;  // [s] a quarter of a turn of the mirror
  constexpr double kFewPairs = 1000;
  const std::size_t lasers = beams.laser.empty() ? 0 : std::ranges::max(beams.laser) + std::size_t{1};
  std::vector<Mean> pairs(lasers);
  std::vector<Mean> alone(lasers);
  for (std::size_t s = 0; s + 1 < residuals.first.size(); ++s) {
    for (std::size_t k = residuals.first[s]; k < residuals.first[s + 1]; ++k) {
      const std::uint32_t own = residuals.beam[k];
      alone[beams.laser[own]].add(std::pow(residuals.value[k], 2), residuals.weight[k]);
      if (k == residuals.first[s]) continue;
      const std::uint32_t before = residuals.beam[k - 1];
      if (beams.laser[before] != beams.laser[own] || beams.time[own] - beams.time[before] > kOneScan)
        continue;
      pairs[beams.laser[own]].add(std::pow(residuals.value[k] - residuals.value[k - 1], 2) / 2,
                                  residuals.weight[k - 1] * residuals.weight[k]);
    }
  }
  std::vector<double> noise;
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    noise.push_back(std::sqrt(pairs[laser].weight > kFewPairs ? pairs[laser].value() : alone[laser].value()));
  }
  return noise;
}

/// What noise leaves of a simulated recording, once planes have been fitted to it.
///
/// @param noise  [m] of each residual
std::vector<double> simulated(const Residuals& measured, const std::vector<double>& noise,
                              std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(measured.value.size());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = noise[k] * normal(random);
  for (std::size_t s = 0; s < measured.planes.size(); ++s) {
    const auto n = static_cast<Eigen::Index>(measured.first[s + 1] - measured.first[s]);
    if (n == 0) continue;
    const auto first = static_cast<std::ptrdiff_t>(measured.first[s]);
    Eigen::Map<Eigen::VectorXd> own(values.data() + first, n);
    const Eigen::VectorXd roots =
        Eigen::Map<const Eigen::VectorXd>(measured.weight.data() + first, n).cwiseSqrt();
    const Eigen::VectorXd weighted = roots.cwiseProduct(own);
    own -= (measured.planes[s] * (measured.planes[s].transpose() * weighted)).cwiseQuotient(roots);
  }
  return values;
}

struct Covariate {
  std::string name;
  std::string unit;
  std::function<double(std::size_t residual)> value;
};

std::vector<Covariate> covariates(const Evidence& evidence, const Residuals& residuals) {
  const Measurements& beams = evidence.sample().beams;
  const PlateTrajectory& plate = *evidence.sample().plate;
  const auto beam = [&residuals](std::size_t k) { return residuals.beam[k]; };
  const auto plate_at = [&plate, &beams, beam](std::size_t k) {
    return plate.at(beams.time[beam(k)]).value_or(PlateState{});
  };
  return {
      {"mirror angle", "rad", [&beams, beam](std::size_t k) { return double{beams.mirror_angle[beam(k)]}; }},
      {"plate angle", "rad",
       [plate_at](std::size_t k) { return std::remainder(plate_at(k).angle, 2 * std::numbers::pi); }},
      // Where the surface is: sorted by what was measured, noise would look like a profile.
      {"range", "m",
       [&beams, &residuals, beam](std::size_t k) { return beams.range[beam(k)] - residuals.value[k]; }},
      {"incidence", "rad",
       [&residuals](std::size_t k) { return std::acos(std::min(1.0, residuals.cosine[k])); }},
      {"remission", "", [&beams, beam](std::size_t k) { return double{beams.remission[beam(k)]}; }},
      {"plate rate", "rad/s", [plate_at](std::size_t k) { return plate_at(k).rate; }},
      {"time", "s", [&beams, beam](std::size_t k) { return beams.time[beam(k)]; }},
  };
}

/// One profile's bins: which residuals are in each.
struct Layout {
  Profile profile;
  std::vector<std::uint32_t> residual;  // of the laser, in the order of the covariate
  std::vector<std::size_t> first;       // of each bin; one more than there are
};

std::vector<Layout> layouts(const Evidence& evidence, const Residuals& residuals) {
  const Measurements& beams = evidence.sample().beams;
  std::map<std::size_t, std::vector<std::uint32_t>> of_laser;
  for (std::uint32_t k = 0; k < residuals.beam.size(); ++k)
    of_laser[beams.laser[residuals.beam[k]]].push_back(k);
  std::vector<Layout> all;
  for (const auto& [name, unit, value] : covariates(evidence, residuals)) {
    for (const auto& [laser, members] : of_laser) {
      std::vector<double> values(members.size());
      for (std::size_t k = 0; k < members.size(); ++k) values[k] = value(members[k]);
      std::vector<std::size_t> order(members.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::stable_sort(order, {}, [&](std::size_t k) { return values[k]; });
      if (order.empty() || values[order.front()] == values[order.back()]) continue;
      Layout layout{.profile = {.covariate = name, .unit = unit, .laser = laser, .bins = {}},
                    .residual = {},
                    .first = {0}};
      for (std::size_t b = 0; b < kBins; ++b) {
        const std::size_t end = (b + 1) * order.size() / kBins;
        double sum = 0;
        for (std::size_t k = layout.first.back(); k < end; ++k) {
          sum += values[order[k]];
          layout.residual.push_back(members[order[k]]);
        }
        const auto count = static_cast<double>(std::max<std::size_t>(1, end - layout.first.back()));
        layout.profile.bins.push_back({.at = sum / count});
        layout.first.push_back(end);
      }
      all.push_back(std::move(layout));
    }
  }
  return all;
}

struct BinMean {
  double value = 0;
  double error = 0;  // in units of the noise
};

BinMean mean_in(const Layout& layout, std::size_t bin, const std::vector<double>& values,
                const std::vector<double>& weights) {
  double sum = 0;
  double weight = 0;
  double squares = 0;
  for (std::size_t k = layout.first[bin]; k < layout.first[bin + 1]; ++k) {
    const double w = weights[layout.residual[k]];
    sum += w * values[layout.residual[k]];
    weight += w;
    squares += w * w;
  }
  if (!(weight > 0)) return {};
  return {.value = sum / weight, .error = std::sqrt(squares) / weight};
}

/// How far a profile is from nothing: χ² of its bins, standardised.
double departure(const Layout& layout, const std::vector<double>& values, const std::vector<double>& weights,
                 double noise) {
  double chi2 = 0;
  for (std::size_t b = 0; b < kBins; ++b) {
    const BinMean mean = mean_in(layout, b, values, weights);
    if (mean.error > 0) chi2 += std::pow(mean.value / (mean.error * noise), 2);
  }
  return (chi2 - kBins) / std::sqrt(2.0 * kBins);
}

}  // namespace

SideBySide side_by_side(const Evidence& evidence, const SurfelSettings& settings, std::uint64_t seed) {
  const Residuals residuals = residuals_in(evidence, settings);
  const auto& weights = residuals.weight;
  SideBySide result;
  const Measurements& beams = evidence.sample().beams;
  result.noise = noise_of(residuals, beams);
  std::vector<double> noise;
  for (const std::uint32_t beam : residuals.beam) noise.push_back(result.noise[beams.laser[beam]]);
  const auto all = layouts(evidence, residuals);

  std::vector<double> greatest(kSimulations);
  for_each_index(kSimulations, [&](std::size_t s) {
    const auto values = simulated(residuals, noise, seed + s);
    for (const Layout& layout : all) {
      greatest[s] =
          std::max(greatest[s], departure(layout, values, weights, result.noise[layout.profile.laser]));
    }
  });
  const auto shown = simulated(residuals, noise, seed + kSimulations);
  for (const Layout& layout : all) {
    Profile profile = layout.profile;
    double square = 0;
    for (std::size_t b = 0; b < kBins; ++b) {
      const BinMean mean = mean_in(layout, b, residuals.value, weights);
      Profile::Bin& bin = profile.bins[b];
      bin.measured = mean.value;
      bin.error = mean.error * result.noise[profile.laser];
      bin.simulated = mean_in(layout, b, shown, weights).value;
      square += (std::pow(bin.measured, 2) - std::pow(bin.error, 2)) / kBins;
    }
    profile.rms = std::sqrt(std::max(0.0, square));
    const double own = departure(layout, residuals.value, weights, result.noise[profile.laser]);
    const auto above = std::ranges::count_if(greatest, [&](double other) { return other >= own; });
    profile.p_value = (1.0 + static_cast<double>(above)) / (1.0 + kSimulations);
    result.p_value = std::min(result.p_value, profile.p_value);
    result.profiles.push_back(std::move(profile));
  }
  return result;
}

}  // namespace crisp
