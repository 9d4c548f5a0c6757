// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/estimate/parameter_prior.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/model/added_terms.hpp"
#include "pipeline/quality/surfel_equations.hpp"
#include "plugins/diagnose/model/candidates.hpp"

namespace crisp::diagnose {

/// Jacobian of the ranges with respect to the base parameters (λ, τ, α, η, skews of clocks) and the size
/// parameters of every candidate, whether the model has the candidate's term or not.
class CandidateJacobian {
 public:
  /// @param model  the current model with its terms
  /// @param base   indices of the estimated base parameters in the model's values
  CandidateJacobian(const SensorModel& model, std::vector<std::size_t> base,
                    std::vector<Candidate> candidates, const TermRegistry& terms);

  std::size_t parameters() const { return parameters_; }  ///< columns; the base comes first: 0, 1, …
  std::size_t base() const { return base_; }              ///< number of base parameters
  const std::vector<std::string>& names() const {
    return names_;
  }  ///< per column: "laser2.mirror.cone.kappa"
  const std::vector<Candidate>& candidates() const { return candidates_; }
  /// Columns of one candidate's size parameters. Shape parameters (forms) have no column. Forms of one
  /// candidate share the columns of what is the same in all of them.
  const std::vector<std::size_t>& of(std::size_t candidate) const { return of_[candidate]; }
  /// Size parameters of the candidate less their neutral values, in the current model.
  Eigen::VectorXd sizes_of(std::size_t candidate) const;

  /// Adds what is known of the base parameters from elsewhere: the rig's nominal values, and clock lines.
  void add_prior(quality::NormalEquations& equations, const estimate::ParameterPrior& prior) const;

  /// Rows of the Jacobian: range changes normal to the surfels. They refer to `sample` and to this object,
  /// which must outlive them.
  quality::DerivativeRows rows(const estimate::Sample& sample) const;

 private:
  void add_columns(std::size_t candidate);
  void add_terms_of_model();
  model::AddedTerms terms_to_add() const;

  std::vector<Candidate> candidates_;
  const TermRegistry& terms_;
  std::vector<std::vector<std::size_t>> of_;
  std::vector<std::size_t> first_form_;  // of each candidate, the first form of the same candidate
  std::vector<std::string> names_;
  std::size_t base_ = 0;
  std::size_t parameters_ = 0;
  SensorModel model_;
  std::vector<std::size_t> free_;     // parameters of the model: the base's and its terms'
  std::vector<std::size_t> columns_;  // of the Jacobian, for each of `free_`
  model::AddedTerms added_;           // the candidates that the model does not have
};

}  // namespace crisp::diagnose
