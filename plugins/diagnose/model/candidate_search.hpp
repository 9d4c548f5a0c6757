// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/model/hypothesis.hpp"
#include "plugins/diagnose/model/residual_profiles.hpp"
#include "plugins/diagnose/model/stepwise_selection.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"

namespace crisp::diagnose {

/// Settings of the candidate search and of the diagnosis.
struct DiagnosisSettings {
  estimate::RefinementSettings refinement;
  SelectionSettings selection;
  std::size_t beams = 150'000;  ///< beams of the first candidate tests and of the residual profiles
  std::size_t refine_beams =
      800'000;                ///< beams of the refined search for causes; no refined search up to `beams`
  double min_effect = 0.008;  ///< [σ] minimum effect of a cause in the refined search (RMS change of ranges)
  int rounds = 8;             ///< maximum number of model extensions
  std::set<std::string> excluded = {};     ///< candidates that are already estimated from other data
  std::function<bool()> interrupted = {};  ///< cancellation query, called from several threads
};

/// Detection limit of a candidate that these data hardly observe.
struct Limit {
  std::string name;
  double size = 0;          ///< [m] largest undetectable RMS change of ranges; infinite if unobservable
  std::string combination;  ///< identifiable combination instead: see known_instead()
};

/// Indices of the base model's parameters (λ, τ, α, η, skews of clocks) that a refinement estimated, or held
/// since they are unobservable.
std::vector<std::size_t> base_of(const estimate::Refinement& refinement);

/// Score tests of all candidates at one model (Rao's score test on the linearized problem).
class CandidateSearch {
 public:
  /// @param observations  evaluated at the model. This object refers to `observations`, `terms` and
  /// `settings`,
  ///                      which must outlive it
  /// @param at            the refined model with the list of its estimated parameters
  /// @param left          residual profiles of the model. Fine shapes become candidates only over the
  /// covariate
  ///                      with the largest systematic residual of a laser
  CandidateSearch(const SurfaceObservations& observations, const estimate::Refinement& at,
                  const TermRegistry& terms, const DiagnosisSettings& settings,
                  const ProfileComparison& left = {});

  const std::vector<std::size_t>& base() const { return base_; }
  std::size_t tests() const { return tests_; }  ///< number of different candidates tested

  /// Selects the candidates that the model needs, with their estimates (stepwise selection).
  ///
  /// @param rejected  names of candidates that are excluded from the selection
  std::vector<Hypothesis> needs(const std::set<std::string>& rejected) const;

  /// The same among some candidates only.
  std::vector<Hypothesis> needs_of(const std::vector<Candidate>& some) const;

  /// Repeats the selection with more beams, which detects smaller effects. Besides the families that the
  /// model has, it selects causes' own formulas only: real walls have small shapes that descriptions would
  /// fit.
  std::vector<Hypothesis> refine_search(const std::set<std::string>& rejected) const;

  /// Other causes than the accepted ones whose detection limit, given these, exceeds a quarter of the range
  /// noise in every form.
  std::vector<Limit> unobservable(const std::vector<Hypothesis>& given) const;

 private:
  struct View {
    CandidateJacobian jacobian;
    quality::NormalEquations equations;
  };
  View view(std::vector<Candidate> candidates, std::size_t beams) const;
  std::vector<Hypothesis> needs_in(const View& view, const SelectionSettings& selection,
                                   const std::set<std::string>& rejected) const;
  std::vector<Candidate> promising() const;

  const SurfaceObservations& observations_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  SensorModel model_;
  std::vector<std::size_t> base_;  // indices of the estimated base parameters (λ, τ, α, η)
  View all_;
  std::size_t tests_ = 0;
};

}  // namespace crisp::diagnose
