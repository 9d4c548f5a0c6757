// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/scene_bound.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

#include "pipeline/estimate/bound.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/identifiability.hpp"
#include "pipeline/estimate/observability.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::study {
namespace {

/// Newell's normal of a polygon, which no corner in line with its neighbours disturbs.
Eigen::Vector3d normal_of(const simulate::Surface& surface) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < surface.corners.size(); ++i) {
    sum += surface.corners[i].cross(surface.corners[(i + 1) % surface.corners.size()]);
  }
  return sum.normalized();
}

/// Beams on flat surfaces, and their surfaces. Curved things, foliage and moving things carry too little
/// information, or too intricate, to be counted.
struct HitFlat {
  estimate::Sample sample;
  std::vector<std::uint32_t> surface;
};
HitFlat hit_flat(const simulate::SimulatedMeasurements& all, const simulate::Scene& scene) {
  HitFlat hit{.sample = {.plate = &all.plate}, .surface = {}};
  hit.sample.beams.epoch_ns = all.beams.epoch_ns;
  for (std::size_t i = 0; i < all.beams.size(); ++i) {
    if (all.surface[i] >= scene.surfaces.size()) continue;
    hit.sample.beams.append(all.beams, i);
    hit.surface.push_back(all.surface[i]);
  }
  return hit;
}

/// Where `some` of `all` are among them.
std::vector<Eigen::Index> places_of(const std::vector<std::size_t>& some,
                                    const std::vector<std::size_t>& all) {
  std::vector<Eigen::Index> at;
  for (const std::size_t slot : some) at.push_back(std::ranges::find(all, slot) - all.begin());
  return at;
}

/// The least errors of `known`, which are some of `free`; infinite for the rest.
Eigen::VectorXd errors_of_known(const Eigen::MatrixXd& information, const std::vector<std::size_t>& free,
                                const std::vector<std::size_t>& known) {
  const std::vector<Eigen::Index> at = places_of(known, free);
  const Eigen::VectorXd least = estimate::least_std_errors(information(at, at));
  Eigen::VectorXd errors =
      Eigen::VectorXd::Constant(information.rows(), std::numeric_limits<double>::infinity());
  for (Eigen::Index k = 0; k < least.size(); ++k) errors[at[static_cast<std::size_t>(k)]] = least[k];
  return errors;
}

}  // namespace

simulate::ScannerSettings without_noise(simulate::ScannerSettings scanner) {
  scanner.range.sigma = 0;
  scanner.range.quantum = 0;
  scanner.encoder_quantised = false;
  for (simulate::LaserEffects& effects : scanner.laser_effects) {
    const simulate::NoiseEffects& noise = effects.noise;
    effects.noise = {.divergence = noise.divergence, .aperture = noise.aperture, .merge = noise.merge};
  }
  return scanner;
}

SceneBound scene_bound(const simulate::ScannerSettings& scanner, const simulate::Scene& scene,
                       const simulate::Motion& motion, BeamChoice beams, const TermRegistry& terms) {
  const auto exact = simulate_beams(beams, without_noise(scanner), scene, motion, terms);
  const HitFlat hit = hit_flat(exact, scene);
  if (hit.surface.empty()) {
    throw Error("no beam meets a flat surface", "check the scene and the lasers' range");
  }
  std::vector<Eigen::Vector3d> normals;
  for (const simulate::Surface& surface : scene.surfaces) normals.push_back(normal_of(surface));
  const SensorModel truth(exact.truth, terms);
  const estimate::FreeParameters possible = estimate::free_parameters(truth, exact.beams, {});
  const auto& free = possible.free;
  // As in calibration: however many beams there are, they do not determine what hardly moves a point.
  const estimate::FreeParameters parameters =
      estimate::identifiable_parameters(possible, truth, hit.sample, estimate::ParameterPrior{});
  estimate::ParameterPrior prior = estimate::RefinementSettings{}.prior;
  prior.nominal = estimate::nominal_values(scanner.rig);
  Eigen::VectorXd from_rig = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto known = prior.nominal.find(truth.names()[free[k]]);
    if (known == prior.nominal.end()) continue;
    from_rig[static_cast<Eigen::Index>(k)] = 1 / std::pow(known->second.std_error, 2);
  }
  const auto information_with = [&](double encoder_step) -> Eigen::MatrixXd {
    return Eigen::MatrixXd(from_rig.asDiagonal()) +
           estimate::calibration_information(truth, hit.sample, hit.surface, normals, free,
                                             {.range = scanner.range.sigma, .encoder_step = encoder_step});
  };
  const Eigen::MatrixXd information = information_with(0);
  const double step = std::abs(scanner.rig.plate.angle_per_count());
  const std::vector<Eigen::Index> at = places_of(parameters.free, free);
  const estimate::Observability reported =
      estimate::observability(information(at, at), parameters.free, truth.names(),
                              estimate::ranges_of(prior, truth, parameters.free));

  SceneBound bound{.parameters = {},
                   .std_errors = errors_of_known(information, free, reported.known),
                   .with_steps = errors_of_known(information_with(step), free, reported.known),
                   .unobservable = parameters.unobservable,
                   .beams_on = std::vector<std::size_t>(scene.things(), 0),
                   .beams = exact.beams.size(),
                   .no_echo = exact.no_echo};
  for (const std::size_t slot : free) bound.parameters.push_back(truth.names()[slot]);
  bound.unobservable.insert(bound.unobservable.end(), reported.unobservable.begin(),
                            reported.unobservable.end());
  for (const auto surface : exact.surface) ++bound.beams_on[surface];
  return bound;
}

}  // namespace crisp::study
