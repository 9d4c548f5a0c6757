// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "plugins/diagnose/model/candidate_jacobian.hpp"
#include "plugins/diagnose/model/score_test.hpp"

namespace crisp::diagnose {

/// A candidate that could replace a selected one.
struct CompetingCandidate {
  std::size_t candidate = 0;
  /// BIC of the selected candidate less this one's, for independent beam errors. For the general member of
  /// another family: what the selected candidate still gains once that member is in the model.
  double behind = 0;
};

/// A selected candidate with its competitors.
struct SelectedCandidate {
  std::size_t candidate = 0;
  ScoreTest test;                                ///< given all other selected candidates
  std::vector<CompetingCandidate> alternatives;  ///< the nearest first, one form of each
};

/// A selection without one of its members.
std::vector<std::size_t> without(std::vector<std::size_t> taken, std::size_t one);

/// Which causes the data do not resolve from a selected one.
class Competition {
 public:
  /// A curve is none if the data bound its size, by so many standard errors, to less than this part of its
  /// level.
  static constexpr double kPartOfLevel = 0.5;
  static constexpr double kCurveErrors = 2;

  /// @param equations  normal equations in the Jacobian's columns; both outlive this
  Competition(const CandidateJacobian& jacobian, const quality::NormalEquations& equations)
      : jacobian_(jacobian), equations_(equations) {}

  /// A selected candidate with the causes that could be in its place, each in its best form.
  SelectedCandidate with_competitors(const std::vector<std::size_t>& taken, std::size_t one) const;

  /// The same with the families that these data do not resolve from its own. Families compete by their
  /// general members, whatever formula suffices here: one that leaves nothing for the selected candidate to
  /// explain could be the cause as well. (The reverse holds by the selection: it ended where no other family
  /// gains anything.) Lasers of one make have the same cause, so that a cause of several lasers also competes
  /// with the other family in all of them.
  SelectedCandidate with_competing_families(const std::vector<std::size_t>& taken, std::size_t one) const;

  /// The candidates of other families that act on the same beams, each with the levels that are conventions.
  std::vector<std::vector<std::size_t>> replacements_of(std::size_t one) const;

 private:
  /// Decrease of the BIC by some selected candidates where others stand in their place.
  double remaining(const std::vector<std::size_t>& some, const std::vector<std::size_t>& instead,
                   const std::vector<std::size_t>& taken) const;
  /// The same term in each laser of some candidates.
  std::vector<std::size_t> in_each_laser(std::size_t candidate, const std::vector<std::size_t>& some) const;
  /// Some candidates and the levels of those whose zero is a convention.
  std::vector<std::size_t> with_levels(std::vector<std::size_t> some) const;
  bool is_general_member(std::size_t candidate) const;
  /// Whether a candidate could be the level of a cause whose curve the data leave room for.
  bool could_be_level(const SelectedCandidate& choice, std::size_t cause,
                      const std::vector<std::size_t>& taken) const;
  /// Whether the candidate acts on the same beams, and is of another family.
  bool could_replace(std::size_t candidate, std::size_t one) const;
  bool is_taken(std::size_t candidate, const std::vector<std::size_t>& taken) const;
  /// Adds a competitor, or brings one of its family nearer.
  void add_competitor(SelectedCandidate& choice, std::size_t candidate, double behind) const;

  const CandidateJacobian& jacobian_;
  const quality::NormalEquations& equations_;
};

}  // namespace crisp::diagnose
