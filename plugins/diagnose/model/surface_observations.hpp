// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/model/candidate_jacobian.hpp"

namespace crisp::diagnose {

/// Which surfaces beams are compared with: those that a refinement ends with, for the sensor model; or those
/// that it begins with, which neither grow into edges nor end before them, for what edges do to ranges.
enum class SurfacesOf { kRefinement, kSearch };

/// @param sample  at least one beam
Coverage coverage_of(const estimate::Sample& sample);

/// Flat surfaces in the beams of a sample, with the normal equations at a model. Surfaces are selected
/// without regard to the agreement of the views on them.
class SurfaceObservations {
 public:
  /// @param sample  all beams, covered by the encoder readings; their incidence angles are set here
  /// @param most    number of beams on surfels(), evenly subsampled
  /// @param interrupted  cancellation query of equations(), called from several threads
  /// @param known   surfaces that the model was fitted to, with these beams; null: they are searched for
  SurfaceObservations(const SensorModel& model, estimate::Sample sample,
                      const estimate::RefinementSettings& settings, std::size_t most,
                      std::function<bool()> interrupted = {}, SurfacesOf of = SurfacesOf::kRefinement,
                      const estimate::SurfaceMap* known = nullptr);

  const estimate::Sample& sample() const { return sample_; }
  const quality::Surfels& surfels() const { return surfels_; }  ///< with `most` beams
  quality::BeamsView beams() const { return placed_.view(noise_); }
  const estimate::PlacedBeams& placed() const { return placed_; }
  Coverage coverage() const { return coverage_; }

  /// Normal equations at the model, in the Jacobian's columns, with divisions into blocks of correlated
  /// errors, and with the settings' prior of base parameters.
  ///
  /// @param most  number of beams used, evenly subsampled
  /// @throws Interrupted
  quality::NormalEquations equations(const CandidateJacobian& jacobian, std::size_t most) const;

 private:
  estimate::Sample sample_;
  estimate::PlacedBeams placed_;
  std::vector<float> noise_;  ///< relative noise of the beams; empty: equal
  quality::SurfelSettings settings_;
  estimate::ParameterPrior prior_;
  quality::Surfels all_;      ///< with all beams
  quality::Surfels surfels_;  ///< with `most` of them
  Coverage coverage_;
  std::vector<quality::Division> shared_;
  std::function<bool()> interrupted_;
};

}  // namespace crisp::diagnose
