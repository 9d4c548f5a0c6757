// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/estimate/search_range.hpp"
#include "pipeline/estimate/view_consistency.hpp"
#include "pipeline/quality/surfel_equations.hpp"

namespace crisp {

struct RefinementSettings {
  std::vector<std::string> fixed;  ///< parameters to be left alone: see free_parameters()
  std::vector<std::string> terms;  ///< of the model, to be found as well: see wanted_terms.hpp
  bool forms = false;  ///< whether the terms' forms are to be found as well, from about the right ones
  SurfelSettings surfels;
  SearchRange prior{.lambda = 0.05, .tau = 0.03, .alpha = 0.05, .eta = 0.01, .other = 0.05};  ///< see below
  double angle_step = 0;   ///< [rad] of the encoder, for the standard errors; 0: none
  double angle_error = 0;  ///< [rad] standard deviation of the plate's angle at a beam's time: see ViewErrors
  int max_rounds = 20;
  double tolerance = 0.02;  ///< [standard errors] steps below which the refinement has converged
};

struct Refinement {
  Outcome outcome;
  std::size_t surfels = 0;  ///< flat surfaces found at last
  std::size_t beams = 0;    ///< beams on them that count
  double chi2 = 0;          ///< weighted squares of the distances to them, in units of the noise, per freedom
  double scatter =
      0;  ///< [m] of ranges from neighbour to neighbour on a surface, see neighbour_noise(); 0: unknown
  std::vector<ViewConsistency> views;  ///< how consistent the beams' views of the surfaces are
  int rounds = 0;
  int restarts = 0;  ///< how often it began anew since its start was far off
  bool converged = false;
};

/// One step of the work: its number, and whether the work is to go on.
using RoundReporter = std::function<bool(int round)>;

/// Estimates λ, τ, α, η and the terms that are wanted by weighted least squares in the distances of all beams
/// to the flat surfaces that they meet, whose planes are estimated with them (projected out). Against RQE it
/// has no bias by a kernel's width and uses all beams; but it needs a start that is right to some
/// centimetres, which RQE gives.
///
/// Each round places the beams, finds the surfaces (anew until steps are small) and takes one Gauss-Newton
/// step. The start counts as an observation with the standard deviations `prior`; what the data do not tell
/// better is named and kept.
///
/// Beams in the plate's plane alone, as in the paper's experiments, see walls as lines, which are taken to be
/// upright: see wall_lines().
///
/// @param start   right to some centimetres and degrees
/// @param sample  all beams; need not be covered
/// @throws Error  if no flat surface is seen, or if nothing is left to be turned
Refinement refine_by_surfels(const SensorModel& start, const Sample& sample,
                             const RefinementSettings& settings, const RoundReporter& report = {});

}  // namespace crisp
