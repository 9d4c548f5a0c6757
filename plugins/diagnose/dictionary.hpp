// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfel_equations.hpp"
#include "plugins/diagnose/candidates.hpp"

namespace crisp {

/// The derivatives of everything that could be said of a recording side by side: of λ, τ, α and η, and of
/// each candidate, those that the model has and those that could be added to it.
class Dictionary {
 public:
  /// @param model  as it is, with the terms that it has
  /// @param base   indices into its values: those of λ, τ, α, η that are estimated with whatever is added
  Dictionary(const SensorModel& model, std::vector<std::size_t> base, std::vector<Candidate> candidates,
             const TermRegistry& terms);

  std::size_t parameters() const { return parameters_; }            ///< those of the base first: 0, 1, …
  std::size_t base() const { return base_; }                        ///< how many of them are the base's
  const std::vector<std::string>& names() const { return names_; }  ///< of each: "laser2.mirror.cone.kappa"
  const std::vector<Candidate>& candidates() const { return candidates_; }
  /// Those of one candidate that say how large it is; its forms are not among them.
  const std::vector<std::size_t>& of(std::size_t candidate) const { return of_[candidate]; }
  /// By how much these are off their neutral values, in the model as it is.
  Eigen::VectorXd sizes_of(std::size_t candidate) const;

  /// How all of them move beams across surfels. Refers to the sample and to this, which must outlive it.
  DerivativeRows rows(const Sample& sample) const;

 private:
  /// A few candidates, in a model of their own: what one sweep of automatic differentiation takes.
  struct Page {
    SensorModel model;
    std::vector<std::size_t> free;     // of the model
    std::vector<std::size_t> columns;  // of the dictionary, for each of `free`
  };
  void add_page(const SensorModel& model, const std::vector<std::size_t>& some);
  std::vector<std::vector<std::size_t>> pages_of(std::size_t owner) const;

  std::vector<Candidate> candidates_;
  const TermRegistry& terms_;
  std::vector<std::vector<std::size_t>> of_;
  std::vector<std::string> names_;
  std::size_t base_ = 0;
  std::size_t parameters_ = 0;
  std::vector<Page> pages_;
};

}  // namespace crisp
