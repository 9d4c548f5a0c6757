// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/estimate/consider_covariance.hpp"
#include "pipeline/estimate/flat_surfaces.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::estimate {

/// Gauss-Newton steps of a model against the flat surfaces that its beams meet, with the start as one more
/// observation (a Gaussian prior).
class SurfelRefiner {
 public:
  /// @param sample  beams that encoder readings cover at every η of refined_lags()
  /// @param free    indices of the parameters to be estimated
  /// @param known   surfaces to begin with; null: they are searched for
  SurfelRefiner(const SensorModel& start, Sample sample, std::vector<std::size_t> free,
                const RefinementSettings& settings, const SurfaceMap* known = nullptr);

  /// Places the beams, updates the surfaces and takes one step.
  ///
  /// @return  whether the steps have converged
  /// @throws Error  if no flat surface is seen
  bool step();

  /// Holds at their start the parameters that the data do not determine. Holds none as long as surfaces are
  /// searched for, since few may have been found yet.
  std::vector<Unobservable> hold_unobservable();

  /// Widens the standard errors to what pieces of the recording, directions of the mirrors, or places on the
  /// surfaces disagree by.
  void widen_by_shared_errors();

  /// Adds to the covariance what held parameters may be off by, and no longer calls free what hangs on them.
  ///
  /// @param unobservable  the held parameters; gets those that hang on them
  void consider_held(std::vector<Unobservable>& unobservable);

  /// Adds to the covariance what parameters that were fixed by request may be off by, by the rig's standard
  /// deviations.
  ///
  /// @return  a caveat if free parameters hang on fixed ones whose standard deviation the rig does not give
  std::optional<std::string> consider_fixed(const std::vector<std::size_t>& fixed);

  /// Takes the model as the start, which counts as an observation.
  void take_as_start() { start_ = model_; }

  const SensorModel& start() const { return start_; }
  const SensorModel& model() const { return model_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  const std::vector<std::size_t>& free() const { return free_; }
  double last_step() const { return last_step_; }  ///< [standard errors] of the parameter that moved most

  Refinement result() const;

  /// Adds the noise by neighbours and the agreement of the views of the surfaces, with their caveats.
  void compare_views(Refinement& result) const;

 private:
  bool is_moving() const;
  Eigen::VectorXd posterior_step(const PlacedBeams& placed);
  void update_damping(const Eigen::VectorXd& step);
  Eigen::VectorXd widening_by_quantization(const quality::NormalEquations& without) const;
  Eigen::VectorXd keep_covered(Eigen::VectorXd values) const;
  double prior_of_held(const std::string& name) const;
  ConsiderCovariance consider_with(const std::vector<std::size_t>& held, const Eigen::VectorXd& prior) const;
  void remove(std::size_t at);
  bool update_noise(const quality::BeamsView& placed);
  quality::Surfels select_static(const quality::Surfels& found, const quality::BeamsView& beams);
  std::vector<std::string> lasers() const;

  SensorModel start_;
  SensorModel model_;
  Sample sample_;
  std::vector<std::size_t> free_;
  const RefinementSettings& settings_;
  std::unique_ptr<FlatSurfaces> surfaces_;
  std::vector<bool> is_static_;  // of the surfels
  std::vector<float> noise_;     // of the beams, relative to one another
  int noise_updates_ = 0;
  int selections_ = 0;      // of static surfaces among the final ones
  quality::Surfels all_;    // in the last round
  quality::Surfels found_;  // of them those that count
  quality::NormalEquations equations_;
  Eigen::MatrixXd information_;
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd last_change_;
  double damping_ = 1;  // of the steps
  double last_step_ = std::numeric_limits<double>::infinity();
  double last_shift_ = std::numeric_limits<double>::infinity();  // of beams, in units of their noise
};

/// The η at which the encoder readings have to cover a refinement's beams.
LagRange refined_lags(const SensorModel& start, const ParameterPrior& prior);

}  // namespace crisp::estimate
