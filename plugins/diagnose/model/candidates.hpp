// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include <crisp/sensor_model.hpp>

namespace crisp::diagnose {

struct ScoreTest;

/// One candidate extension of the sensor model: a term of the plate or of one laser, in one form (a fixed
/// value of its nonlinear parameter).
struct Candidate {
  std::size_t owner = 0;  ///< index of the laser; for the plate, the number of lasers
  TermParameters term;    ///< neutral values, except the form's
  std::size_t forms = 1;  ///< number of forms on the grid
  double form = 0;        ///< position on the grid of forms: see in_form()

  /// Another form on the grid, compared with the best one.
  struct OtherForm {
    Eigen::VectorXd off;  ///< estimate in this form less the estimate in the best form, per parameter
    double behind = 0;    ///< [2 nat] likelihood ratio to the best form, for independent beam errors
  };
  std::vector<OtherForm> other_forms;  ///< the evaluated forms of the grid
  std::string name;                    ///< "laser2.mirror.cone", "encoder.eccentricity"
  std::string covariate;               ///< see TermInfo: empty for a term with a formula of its own
  std::string family;                  ///< see family_of(): the cause, or empty
  std::string level;                   ///< of the family: see TermInfo

  bool is_fine = false;  ///< see TermInfo

  bool in_model = false;  ///< whether the calibration has it

  bool is_cause() const { return !family.empty(); }
  bool is_shape() const { return !covariate.empty(); }

  /// The laser this candidate affects; empty for plate terms, which affect all lasers.
  std::optional<std::size_t> laser() const { return name == term.term ? std::nullopt : std::optional(owner); }

  /// The cause with its owner: "laser2.range.incidence".
  std::string cause_name() const {
    return name.substr(0, name.size() - term.term.size()) + (is_cause() ? family : term.term);
  }
  /// Whether both are members of one cause's family, of one owner.
  bool is_of_family(const Candidate& other) const { return cause_name() == other.cause_name(); }

  /// Whether this is the level of another cause of the same laser, whose zero is a convention.
  bool is_level_of(const Candidate& other) const {
    return is_cause() && family == other.level && owner == other.owner;
  }

  /// Whether both are forms of one term of one owner.
  bool is_form_of(const Candidate& other) const { return name == other.name; }
};

/// Range, time span and shared origins of the recorded beams.
struct Coverage {
  double first = 0;         ///< [s since the run's epoch] time of the first beam
  double last = 0;          ///< [s] time of the last beam
  double farthest = 1e300;  ///< [m] 99 % quantile of the ranges
  bool one_begin = true;    ///< the data are one recording
  bool one_zero = true;     ///< all plate angles count from one zero of the encoder

  /// Whether one set of a term's parameters holds for all recordings.
  bool shares(CountsFrom from) const {
    return from == CountsFrom::kNothing || (from == CountsFrom::kRunsEpoch ? one_begin : one_zero);
  }
};

/// Enumerates the candidates: every term for each owner, in each form of its grid. A term has at most one
/// nonlinear parameter with a grid; further ones stay neutral. Terms that the recordings cannot share are
/// left out. Terms of the calibration keep their form and their values.
std::vector<Candidate> candidates(const TermRegistry& terms, const Calibration& calibration,
                                  const Coverage& coverage);

/// Names of the causes that candidates() leaves out because the recordings cannot share them.
std::vector<std::string> unshared_causes(const TermRegistry& terms, const Coverage& coverage);

/// Returns the candidate in another form.
///
/// @param step  position on the grid of forms: 0 is the first, forms − 1 the last, fractions lie between
Candidate in_form(Candidate candidate, double step, const TermRegistry& terms, const Coverage& coverage);

/// Returns the candidate with the estimates of a score test.
Candidate with_estimates(Candidate candidate, const ScoreTest& test, const TermRegistry& terms);

/// Terms of one owner: of a laser, or of the plate where `owner` is the number of lasers.
std::vector<TermParameters>& terms_of(Calibration& calibration, std::size_t owner);
const std::vector<TermParameters>& terms_of(const Calibration& calibration, std::size_t owner);

/// The term with this name, or nullptr.
const TermParameters* find_term(const std::vector<TermParameters>& terms, const std::string& name);

/// Adds the candidate's term to the calibration.
void add_to(Calibration& calibration, const Candidate& candidate);

/// Replaces all terms of the calibration but nuisances by the candidates' terms.
Calibration with_terms(Calibration calibration, const std::vector<Candidate>& chosen,
                       const TermRegistry& terms);

/// Sets the candidates' values to the calibration's.
std::vector<Candidate> with_values_of(const Calibration& calibration, std::vector<Candidate> chosen);

}  // namespace crisp::diagnose
