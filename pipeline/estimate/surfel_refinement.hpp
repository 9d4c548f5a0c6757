// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/parameter_prior.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/estimate/surface_map.hpp"
#include "pipeline/estimate/view_consistency.hpp"
#include "pipeline/quality/surfel_equations.hpp"

namespace crisp::estimate {

/// What a refinement computes; each value includes those before it.
enum class Detail {
  kModel,           ///< the model; its covariance takes the beams' errors for independent
  kStandardErrors,  ///< errors that beams share are in the covariance
  kViews            ///< `scatter`, `views` and their caveats
};

struct RefinementSettings {
  std::vector<std::string> fixed;  ///< parameters to be left alone: see free_parameters()
  std::vector<std::string> terms;  ///< of the model, to be found as well: see requested_terms.hpp
  bool forms = false;  ///< whether the terms' forms are to be found as well, from about the right ones
  quality::SurfelSettings surfels;
  ParameterPrior prior{
      .lambda = 0.05, .tau = 0.03, .alpha = 0.05, .eta = 0.01, .other = 0.05};  ///< see below
  double angle_step = 0;   ///< [rad] of the encoder, for the standard errors; 0: none
  double angle_error = 0;  ///< [rad] standard deviation of the plate's angle at a beam's time: see ViewErrors
  int max_rounds = 20;
  /// Rounds in which surfaces are searched for, at most. From a degree off, walls that lie apart come
  /// together one after the other.
  int searches = 12;
  double tolerance = 0.02;  ///< [standard errors] steps below which the refinement has converged
  Detail detail = Detail::kViews;
  /// Beams of a step's normal equations at most, evenly subsampled from the surfaces.
  std::size_t equation_beams = std::numeric_limits<std::size_t>::max();
};

struct Refinement {
  Outcome outcome;
  std::size_t surfels = 0;  ///< flat surfaces found at last
  std::size_t beams = 0;    ///< beams on them that count
  double chi2 = 0;  ///< weighted squared distances to them, in units of the noise, per degree of freedom
  double scatter =
      0;  ///< [m] of ranges from neighbour to neighbour on a surface, see neighbour_noise(); 0: unknown
  std::vector<ViewConsistency> views;  ///< how consistent the beams' views of the surfaces are
  int rounds = 0;
  int restarts = 0;  ///< how often it began anew since its start was far off
  bool converged = false;
  bool determines_little = false;  ///< fewer than half of the parameters, which is one of the caveats
  std::shared_ptr<const SurfaceMap> surfaces;  ///< that the model was fitted to; null: there are none
};

/// One step of the work: its number, and whether the work is to go on.
using RoundReporter = std::function<bool(int round)>;

/// Estimates λ, τ, α, η and the requested terms by weighted least squares in the distances of all beams to
/// their flat surfaces, whose planes are estimated jointly (projected out). Unlike RQE it has no bias by a
/// kernel's width and uses all beams; but it needs a start within some centimetres, which RQE gives.
///
/// Each round places the beams, segments the surfaces (anew until steps are small) and takes one Gauss-Newton
/// step. The start counts as an observation with the standard deviations `prior`; unobservable parameters are
/// named and held.
///
/// Beams in the plate's plane alone, as in the paper's experiments, see walls as lines, which are assumed to
/// be upright: see wall_lines().
///
/// @param start   accurate to some centimetres and degrees
/// @param sample  all beams; need not be covered
/// @param known   surfaces that a model near the start was fitted to, with beams of the same recording; null:
/// none, they are searched for
/// @throws Error  if no flat surface is seen, or if no parameter is free
Refinement refine_by_surfels(const SensorModel& start, const Sample& sample,
                             const RefinementSettings& settings, const RoundReporter& report = {},
                             std::shared_ptr<const SurfaceMap> known = nullptr);

}  // namespace crisp::estimate
