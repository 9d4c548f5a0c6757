// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/surface_observations.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/flat_surfaces.hpp"
#include "pipeline/estimate/incidence.hpp"
#include "pipeline/estimate/relative_noise.hpp"
#include "pipeline/estimate/shared_errors.hpp"
#include "pipeline/estimate/static_surfaces.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

using quality::Surfels;

/// Only the beams that count: what was cut off a surface does not return when the others are weighed anew.
Surfels counting(const Surfels& surfels) {
  Surfels some;
  for (const quality::Surfel& surfel : surfels.surfels) {
    std::vector<std::uint32_t> beams;
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
      if (surfels.weights[k] > 0) beams.push_back(surfels.members[k]);
    }
    some.add(surfel, beams);
  }
  return some;
}

/// @param known  final surfaces of a refinement, which are not searched for again; null: none
Surfels found_by(SurfacesOf of, const Surfels* known, const quality::BeamsView& beams,
                 const quality::SurfelSettings& settings) {
  if (of == SurfacesOf::kSearch) return estimate::patches(settings, 1)->update(beams, true);
  Surfels completed =
      counting(known != nullptr ? *known : estimate::patches(settings, 0)->update(beams, true));
  quality::refine_all(completed, beams, settings);
  return completed;
}

Surfels surfaces(SurfacesOf of, const Surfels* known, const quality::BeamsView& beams,
                 const quality::SurfelSettings& settings) {
  const Surfels found = found_by(of, known, beams, settings);
  if (found.surfels.empty()) {
    throw Error("no beam meets a flat surface, so the sensor model cannot be tested",
                "reduce `min_cell`, or record in a place with walls");
  }
  return estimate::kept(found, estimate::static_surfaces(found, beams, settings.noise));
}

bool are_elsewhere(const quality::BeamsView& beams, const quality::BeamsView& before) {
  return !std::ranges::equal(beams.points.x, before.points.x) ||
         !std::ranges::equal(beams.points.y, before.points.y) ||
         !std::ranges::equal(beams.points.z, before.points.z);
}

}  // namespace

Coverage coverage_of(const estimate::Sample& sample) {
  constexpr double kNearlyAll = 0.99;
  auto ranges = sample.beams.range;
  const auto [first, last] = std::ranges::minmax(sample.beams.time);
  const auto recordings = data::recordings_of(*sample.plate);
  return {.first = first,
          .last = last,
          .farthest = statistics::quantile_in_place(ranges, kNearlyAll),
          .one_begin = recordings.size() < 2,
          .one_zero = recordings.empty() || recordings.front().zero == recordings.back().zero};
}

SurfaceObservations::SurfaceObservations(const SensorModel& model, estimate::Sample sample,
                                         const estimate::RefinementSettings& settings, std::size_t most,
                                         std::function<bool()> interrupted, SurfacesOf of,
                                         const estimate::SurfaceMap* known)
    : sample_(std::move(sample)),
      placed_(model, sample_),
      settings_(settings.surfels),
      prior_(settings.prior),
      interrupted_(std::move(interrupted)) {
  std::optional<Surfels> final;
  if (known != nullptr) final = known->of(sample_.beams).surfels;
  const Surfels* begin = final ? &*final : nullptr;
  all_ = surfaces(of, begin, placed_.view(), settings_);
  sample_.beams.cos_incidence = estimate::incidences(all_, placed_.view());
  // Terms of the incidence angle move beams, mostly those of grazing incidence, and thereby the surfaces.
  if (estimate::PlacedBeams moved(model, sample_); are_elsewhere(moved.view(), placed_.view())) {
    all_ = surfaces(of, begin, moved.view(), settings_);
    sample_.beams.cos_incidence = estimate::incidences(all_, moved.view());
    placed_ = estimate::PlacedBeams(model, sample_);
  }
  noise_ = estimate::relative_noise(all_, placed_.view(), sample_.beams, settings_);
  if (!noise_.empty()) quality::refine_all(all_, beams(), settings_);
  surfels_ = quality::thinned(all_, most);
  coverage_ = coverage_of(sample_);
  shared_ = estimate::shared_errors(sample_, all_, beams(), settings.angle_step);
}

quality::NormalEquations SurfaceObservations::equations(const CandidateJacobian& jacobian,
                                                        std::size_t most) const {
  const auto rows = [this, all = jacobian.rows(sample_)](const auto&... of_surfel) {
    if (interrupted_ && interrupted_()) throw Interrupted();
    all(of_surfel...);
  };
  quality::NormalEquations equations = quality::normal_equations(
      quality::thinned(all_, most), beams(), jacobian.parameters(), rows, settings_, shared_);
  jacobian.add_prior(equations, prior_);
  return equations;
}

}  // namespace crisp::diagnose
