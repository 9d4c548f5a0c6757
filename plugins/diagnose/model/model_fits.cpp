// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/model_fits.hpp"

#include <algorithm>

#include <crisp/error.hpp>

#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/model/terms_in.hpp"

namespace crisp::diagnose {
namespace {

/// [standard errors] Steps below which a model is near enough to its optimum to be tested.
constexpr double kModelTolerance = 0.1;

/// The start is a calibration. Where the model lacks a large effect, searches never agree with one another.
constexpr int kSearches = 4;

}  // namespace

void ModelFits::limit_lags(const SensorModel& plain) {
  lags_ = estimate::lag_range(plain, settings_.refinement.prior.eta);
  inside_ = estimate::covered(sample_, lags_.earliest, lags_.latest);
}

void ModelFits::stop_if_requested() const {
  if (settings_.interrupted && settings_.interrupted()) throw Interrupted();
}

estimate::Refinement ModelFits::refined(const Calibration& calibration, const Effort& effort) const {
  estimate::Refinement refinement = refined_with(sample_, calibration, effort);
  if (refinement.surfaces) surfaces_ = refinement.surfaces;
  return refinement;
}

estimate::Refinement ModelFits::refined_with(const estimate::Sample& sample, const Calibration& calibration,
                                             const Effort& effort) const {
  estimate::RefinementSettings settings = settings_.refinement;
  settings.detail = effort.detail;
  settings.equation_beams = effort.equation_beams;
  if (effort.detail == estimate::Detail::kModel) settings.tolerance = kModelTolerance;
  settings.terms = model::terms_in(calibration, terms_);
  settings.forms = true;
  settings.searches = kSearches;
  settings.prior.earliest_eta = lags_.earliest;
  settings.prior.latest_eta = lags_.latest;
  return estimate::refine_by_surfels(
      SensorModel(calibration, terms_), sample, settings,
      [this](int) {
        stop_if_requested();
        return true;
      },
      surfaces_);
}

const ProfileComparison& ModelFits::compared(const estimate::Refinement& fit) const {
  return comparisons_.of(fit.outcome.model, [&] {
    return compare_with_simulation(observed(fit), settings_.refinement.surfels, 1);
  });
}

const SurfaceObservations& ModelFits::observed(const estimate::Refinement& fit) const {
  const SensorModel& model = fit.outcome.model;
  if (!observed_ || observed_->model.names() != model.names() ||
      !std::ranges::equal(observed_->model.values(), model.values())) {
    observed_.reset();
    observed_.emplace(
        Observed{.model = model,
                 .observations = {model, inside_, settings_.refinement, settings_.beams,
                                  settings_.interrupted, SurfacesOf::kRefinement, fit.surfaces.get()}});
  }
  return observed_->observations;
}

}  // namespace crisp::diagnose
