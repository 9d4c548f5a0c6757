// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/departure.hpp"
#include "plugins/diagnose/evidence.hpp"
#include "plugins/diagnose/profiles.hpp"
#include "plugins/diagnose/selection.hpp"

namespace crisp {

struct DiagnosisSettings {
  RefinementSettings refinement;
  SelectionSettings selection;
  std::size_t beams = 150'000;   ///< that candidates are looked at with at first, and residuals compared of
  std::size_t closer = 800'000;  ///< that causes are looked at with in the end; not more than `beams`: never
  double faint = 0.008;          ///< [σ] least RMS change of ranges by which a cause is seen then
  int rounds = 8;                ///< most times that the model is extended and looked at again
  std::set<std::string> excluded = {};     ///< names of candidates that other data rule out
  std::function<bool()> interrupted = {};  ///< asked from several threads, whether the work is to end
};

/// A candidate of which these data tell little.
struct Limit {
  std::string name;
  double size = 0;          ///< [m] RMS change of ranges that would not be seen; may be infinite
  std::string combination;  ///< that is known instead: see known_instead() in beside.hpp
};

/// A look at a model: all that could be added to it, side by side (score tests).
class Survey {
 public:
  /// @param evidence  at the model. This refers to it, to the terms and to the settings, which must outlive
  /// it
  /// @param at        the model, and what of it is estimated
  /// @param left      what departs from it; fine shapes are looked for over what departs the most in a laser
  Survey(const Evidence& evidence, const Refinement& at, const TermRegistry& terms,
         const DiagnosisSettings& settings, const SideBySide& left = {});

  const std::vector<std::size_t>& base() const { return base_; }
  std::size_t looks() const { return looks_; }  ///< different things that are looked for

  /// What the model needs, with values.
  ///
  /// @param refused  names of candidates that are not to be taken
  std::vector<Departure> needs(const std::set<std::string>& refused) const;

  /// The same with more beams, which show what is fainter. Of what the model does not have, causes alone:
  /// real walls have faint shapes, and a cause has to show beside them.
  std::vector<Departure> closer_needs(const std::set<std::string>& refused) const;

  /// Causes that could be a quarter of the noise of ranges, in every form, without being seen beside others.
  std::vector<Limit> unobservable(const std::vector<Departure>& beside) const;

 private:
  struct View {
    Dictionary dictionary;
    NormalEquations equations;
  };
  View view(std::vector<Candidate> candidates, std::size_t beams) const;
  std::vector<Departure> needs_in(const View& view, const SelectionSettings& selection,
                                  const std::set<std::string>& refused) const;
  std::vector<Candidate> promising() const;

  const Evidence& evidence_;
  const TermRegistry& terms_;
  const DiagnosisSettings& settings_;
  SensorModel model_;
  std::vector<std::size_t> base_;  // of the model's values: λ, τ, α, η as far as they are estimated
  View all_;
  std::size_t looks_ = 0;
};

}  // namespace crisp
