// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include <crisp/term.hpp>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/model/candidate_search.hpp"
#include "plugins/diagnose/model/per_model.hpp"
#include "plugins/diagnose/model/residual_profiles.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"

namespace crisp::diagnose {

/// How exact a refinement is.
struct Effort {
  estimate::Detail detail = estimate::Detail::kViews;
  std::size_t equation_beams = std::numeric_limits<std::size_t>::max();
};

/// Fits of sensor models to one recording, with the surfaces and the residuals of each. What was computed for
/// a model is kept, and each fit begins with the surfaces of the last one.
class ModelFits {
 public:
  /// @param sample  all beams; this object refers to the arguments, which must outlive it
  ModelFits(const estimate::Sample& sample, const TermRegistry& terms, const DiagnosisSettings& settings)
      : sample_(sample), terms_(terms), settings_(settings) {}

  /// Keeps the beams that the encoder readings cover at each η near the plain model's, and limits η to that
  /// neighbourhood in further refinements. A distant start may have moved by more than its prior.
  void limit_lags(const SensorModel& plain);

  /// The beams that limit_lags() has kept.
  const estimate::Sample& covered() const { return inside_; }

  /// A refinement with all beams.
  estimate::Refinement refined(const Calibration& calibration, const Effort& effort = {}) const;

  /// A refinement with some of the beams.
  estimate::Refinement refined_with(const estimate::Sample& sample, const Calibration& calibration,
                                    const Effort& effort) const;

  /// The surfaces that a model was fitted to, for what follows with the same model. Valid until those of
  /// another.
  const SurfaceObservations& observed(const estimate::Refinement& fit) const;

  /// Residuals of the fit compared with those of a simulated scanner.
  const ProfileComparison& compared(const estimate::Refinement& fit) const;

  /// Whether these residuals agree with the simulation.
  bool explains_all(const estimate::Refinement& fit) const {
    return compared(fit).p_value > settings_.selection.p_value;
  }

  /// @throws Interrupted  when the settings' `interrupted` returns true
  void stop_if_requested() const;

 private:
  struct Observed {
    SensorModel model;
    SurfaceObservations observations;
  };

  const estimate::Sample& sample_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  estimate::LagRange lags_{.earliest = -std::numeric_limits<double>::infinity(),
                           .latest = std::numeric_limits<double>::infinity()};
  estimate::Sample inside_;
  mutable std::optional<Observed> observed_;
  mutable std::shared_ptr<const estimate::SurfaceMap> surfaces_;  ///< of the last refinement with all beams
  mutable PerModel<ProfileComparison> comparisons_;
};

}  // namespace crisp::diagnose
