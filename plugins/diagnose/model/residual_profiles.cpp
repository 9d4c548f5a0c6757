// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/residual_profiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "pipeline/data/recordings.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/statistics/multiple_testing.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "pipeline/statistics/weighted_mean.hpp"
#include "plugins/diagnose/model/distinct_profiles.hpp"
#include "plugins/diagnose/model/mean_residuals.hpp"
#include "plugins/diagnose/model/quantile_bins.hpp"
#include "plugins/diagnose/model/residuals.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kSimulations = 199;

struct Covariate {
  std::string name;
  std::string unit;
  std::function<double(std::size_t residual)> value;
};

std::vector<Covariate> covariates(const SurfaceObservations& observations, const Residuals& residuals) {
  const Measurements& beams = observations.sample().beams;
  const PlateTrajectory& plate = *observations.sample().plate;
  const auto beam = [&residuals](std::size_t k) { return residuals.beam[k]; };
  const auto plate_at = [&plate, &beams, beam](std::size_t k) {
    return plate.at(beams.time[beam(k)]).value_or(PlateState{});
  };
  return {
      {"mirror angle", "rad", [&beams, beam](std::size_t k) { return double{beams.mirror_angle[beam(k)]}; }},
      {"plate angle", "rad",
       [plate_at](std::size_t k) { return std::remainder(plate_at(k).angle, 2 * std::numbers::pi); }},
      // Range of the surface: measured ranges correlate with their own noise, which would resemble a
      // profile.
      {"range", "m",
       [&beams, &residuals, beam](std::size_t k) {
         return beams.range[beam(k)] - residuals.measured.value[k];
       }},
      {"incidence", "rad",
       [&residuals](std::size_t k) { return std::acos(std::min(1.0, residuals.cosine[k])); }},
      {"remission", "", [&beams, beam](std::size_t k) { return double{beams.remission[beam(k)]}; }},
      {"plate rate", "rad/s", [plate_at](std::size_t k) { return plate_at(k).rate; }},
      {"time", "s", [&beams, beam](std::size_t k) { return beams.time[beam(k)]; }},
      // The fit of planes absorbs the laser's common offset, so the difference of the halves remains.
      {"front/back", "", [&beams, beam](std::size_t k) { return beams.mirror_angle[beam(k)] > 0 ? 1 : 0; }},
  };
}

/// Bins by laser. The fit of planes does not absorb an offset that a laser has on all surfaces.
std::optional<QuantileBins> layout_over_lasers(const Measurements& beams, const Residuals& residuals) {
  std::vector<std::uint32_t> all(residuals.beam.size());
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  std::map<std::size_t, std::size_t> counts;
  for (const std::uint32_t beam : residuals.beam) ++counts[beams.laser[beam]];
  if (counts.size() < 2) return std::nullopt;
  std::ranges::stable_sort(all, {}, [&](std::uint32_t k) { return beams.laser[residuals.beam[k]]; });
  QuantileBins layout{
      .profile = {.covariate = "laser", .unit = "", .laser = kAllLasers, .bins = {}, .share = 1},
      .residual = std::move(all),
      .first = {0}};
  for (const auto& [laser, count] : counts) {
    layout.profile.bins.push_back({.at = static_cast<double>(laser + 1)});
    layout.first.push_back(layout.first.back() + count);
  }
  return layout;
}

std::vector<QuantileBins> layouts(const SurfaceObservations& observations, const Residuals& residuals) {
  const Measurements& beams = observations.sample().beams;
  std::map<std::size_t, std::vector<std::uint32_t>> of_laser;
  for (std::uint32_t k = 0; k < residuals.beam.size(); ++k)
    of_laser[beams.laser[residuals.beam[k]]].push_back(k);
  const data::RecordingNumbers recordings(*observations.sample().plate);
  const std::function<std::size_t(double)> recording_of = [&](double time) { return recordings.of(time); };
  const std::function<std::size_t(double)> alike = [](double) { return std::size_t{0}; };
  std::vector<QuantileBins> all;
  for (const auto& [name, unit, value] : covariates(observations, residuals)) {
    for (const auto& [laser, members] : of_laser) {
      std::vector<double> values(members.size());
      for (std::size_t k = 0; k < members.size(); ++k) values[k] = value(members[k]);
      QuantileBins layout = quantile_bins(members, values, name == "time" ? recording_of : alike);
      if (layout.profile.bins.size() < 2) continue;
      layout.profile.covariate = name;
      layout.profile.unit = unit;
      layout.profile.laser = laser;
      layout.profile.share = static_cast<double>(members.size()) / static_cast<double>(residuals.beam.size());
      all.push_back(std::move(layout));
    }
  }
  if (auto over_lasers = layout_over_lasers(beams, residuals)) all.push_back(std::move(*over_lasers));
  return all;
}

/// Mean residual by simulation and bin.
using SimulatedMeans = std::vector<std::vector<double>>;

/// [m] RMS of the simulated means, per bin.
std::vector<double> errors_of(const SimulatedMeans& means) {
  std::vector<double> errors(means.front().size());
  for (std::size_t b = 0; b < errors.size(); ++b) {
    double squares = 0;
    for (const auto& one : means) squares += one[b] * one[b];
    errors[b] = std::sqrt(squares / static_cast<double>(means.size()));
  }
  return errors;
}

/// [m] RMS range noise of each laser.
///
/// @param noise  of each laser, relative to the noise assumed by the surfels
std::vector<double> sizes_of(const std::vector<double>& noise, const Residuals& residuals,
                             const Measurements& beams) {
  std::vector<statistics::Mean> squares(noise.size());
  for (std::size_t k = 0; k < residuals.size(); ++k)
    squares[beams.laser[residuals.beam[k]]].add(residuals.reported[k] * residuals.reported[k], 1);
  std::vector<double> sizes;
  for (std::size_t laser = 0; laser < noise.size(); ++laser)
    sizes.push_back(noise[laser] * std::sqrt(squares[laser].value()));
  return sizes;
}

}  // namespace

std::map<std::string, double> ProfileComparison::unexplained(std::optional<std::size_t> laser) const {
  std::map<std::string, double> squares;
  for (const Profile& profile : profiles) {
    const bool concerns = !laser || profile.laser == *laser || profile.laser == kAllLasers;
    if (profile.is_significant() && concerns)
      squares[profile.covariate] += profile.share * profile.rms * profile.rms;
  }
  return squares;
}

ProfileComparison compare_with_simulation(const SurfaceObservations& observations,
                                          const quality::SurfelSettings& settings, std::uint64_t seed) {
  const Residuals residuals = residuals_in(observations, settings);
  const Measurements& beams = observations.sample().beams;
  ProfileComparison result;
  const std::vector<double> of_laser = noise_of(residuals, beams);
  result.noise = sizes_of(of_laser, residuals, beams);
  std::vector<double> noise;
  for (const std::uint32_t beam : residuals.beam) noise.push_back(of_laser[beams.laser[beam]]);
  const auto all = layouts(observations, residuals);

  std::vector<SimulatedMeans> means(all.size(), SimulatedMeans(kSimulations));
  std::vector<double> squares(kSimulations);
  std::vector<std::vector<NoiseCounts>> counts(kSimulations);
  quality::for_each_index(kSimulations, [&](std::size_t s) {
    const WeightedResiduals made = simulated(residuals, noise, seed + s);
    squares[s] = shared_square(residuals, made, beams);
    counts[s] = counts_of(made, residuals, noise, beams);
    for (std::size_t p = 0; p < all.size(); ++p) means[p][s] = means_in(all[p], made);
  });
  result.distributions = distributions(counts_of(residuals.measured, residuals, noise, beams), counts);
  result.excess = shared_square(residuals, residuals.measured, beams) -
                  std::accumulate(squares.begin(), squares.end(), 0.0) / double{kSimulations};
  std::vector<double> least(kSimulations, 1.0);
  for (std::size_t p = 0; p < all.size(); ++p) {
    const auto errors = errors_of(means[p]);
    for (std::size_t s = 0; s < kSimulations; ++s)
      least[s] = std::min(least[s], profile_p_value(all[p], means[p][s], errors));
  }
  const double tests = statistics::effective_number_of_tests(least);
  for (std::size_t p = 0; p < all.size(); ++p) {
    const auto own = means_in(all[p], residuals.measured);
    const auto errors = errors_of(means[p]);
    Profile profile = all[p].profile;
    for (std::size_t b = 0; b < own.size(); ++b) {
      profile.bins[b].measured = own[b];
      profile.bins[b].error = errors[b];
      profile.bins[b].simulated = means[p].front()[b];
    }
    profile.rms = systematic_rms(own, errors);
    profile.p_value = statistics::sidak_p_value(tests, profile_p_value(all[p], own, errors));
    result.p_value = std::min(result.p_value, profile.p_value);
    result.profiles.push_back(std::move(profile));
  }
  mark_shadows(result.profiles, all, residuals.measured, tests);
  return result;
}

}  // namespace crisp::diagnose
