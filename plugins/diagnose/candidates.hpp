// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/model/sensor_model.hpp"

namespace crisp {

struct Look;

/// One way to extend the sensor model: a term of the plate or of one laser, in one of its forms.
struct Candidate {
  std::size_t owner = 0;  ///< index of the laser; for the plate, the number of lasers
  TermParameters term;    ///< neutral, but for the form that is tried
  std::size_t forms = 1;  ///< how many are tried
  double form = 0;        ///< which of them this is: see in_form()

  /// Another form, beside the best.
  struct OtherForm {
    Eigen::VectorXd off;  ///< of each of the term's parameters: its value then, less that of the best form
    double behind = 0;    ///< [2 nat] by how much less it explains, errors of beams taken for independent
  };
  std::vector<OtherForm> other_forms;  ///< all that are tried, as far as they have been looked at
  std::string name;                    ///< "laser2.mirror.cone", "encoder.eccentricity"
  std::string covariate;               ///< see TermInfo: empty for a term that names a cause

  bool is_fine = false;  ///< see TermInfo

  bool in_model = false;  ///< whether the calibration has it

  bool is_cause() const { return covariate.empty(); }

  /// That alone whose ranges it changes; nothing of what the plate does, which changes all.
  std::optional<std::size_t> laser() const { return name == term.term ? std::nullopt : std::optional(owner); }

  /// Whether the other is the same in another form.
  bool is_form_of(const Candidate& other) const { return name == other.name; }
};

/// What beams cover, and what recordings have in common.
struct Coverage {
  double first = 0;         ///< [s since the run's epoch] when beams were fired
  double last = 0;          ///< [s]
  double farthest = 1e300;  ///< [m] range that all but a hundredth of them stay below
  bool one_begin = true;    ///< there is but one recording
  bool one_zero = true;     ///< all angles of the plate count from one zero of the encoder

  /// Whether one set of a term's parameters can hold for all.
  bool shares(CountsFrom from) const {
    return from == CountsFrom::kNothing || (from == CountsFrom::kRunsEpoch ? one_begin : one_zero);
  }
};

/// Every term for each owner and in each form that its parameters ask to be tried (one parameter of form a
/// term; further ones are left at their neutral values), but for those that recordings cannot share. Those
/// that the calibration has come in the form that they have there, and with their values.
std::vector<Candidate> candidates(const TermRegistry& terms, const Calibration& calibration,
                                  const Coverage& coverage);

/// The causes that are left out because recordings cannot share them.
std::vector<std::string> unshared_causes(const TermRegistry& terms, const Coverage& coverage);

/// The same with another form.
///
/// @param step  on the scale of the forms that are tried: 0 is the first, forms − 1 the last, fractions lie
///              between
Candidate in_form(Candidate candidate, double step, const TermRegistry& terms, const Coverage& coverage);

/// The candidate with the values that a look found.
Candidate valued(Candidate candidate, const Look& look, const TermRegistry& terms);

/// The terms of one owner: of a laser, or of the plate where the index is the number of lasers.
std::vector<TermParameters>& terms_of(Calibration& calibration, std::size_t owner);
const std::vector<TermParameters>& terms_of(const Calibration& calibration, std::size_t owner);

/// A term by its name; nullptr if there is none.
const TermParameters* find_term(const std::vector<TermParameters>& terms, const std::string& name);

/// The calibration with the candidate's term.
void add_to(Calibration& calibration, const Candidate& candidate);

/// The calibration with the candidates' terms in place of its own.
Calibration with_terms(Calibration calibration, const std::vector<Candidate>& chosen);

/// The candidates with the values that a calibration has for them.
std::vector<Candidate> with_values_of(const Calibration& calibration, std::vector<Candidate> chosen);

}  // namespace crisp
