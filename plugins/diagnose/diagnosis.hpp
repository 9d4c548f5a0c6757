// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/profiles.hpp"
#include "plugins/diagnose/selection.hpp"

namespace crisp {

struct DiagnosisSettings {
  RefinementSettings refinement;
  SelectionSettings selection;
  std::size_t beams = 150'000;  ///< that candidates are looked at with
  int rounds = 5;               ///< most times that the model is extended and looked at again
};

/// One departure from the model that was found.
struct Departure {
  Candidate candidate;  ///< with the values that were found
  Look look;
  struct Rival {
    std::string name;
    double behind = 0;  ///< by how much its BIC is less
    std::string term = {};
    std::size_t owner = 0;
  };
  std::vector<Rival> rivals;  ///< what else could explain it, the likeliest first
  std::vector<Gain> gains;    ///< on turns of the plate that the model was not fitted to
  bool accepted = true;       ///< whether it is part of the extended model
  double unexplained = 0;     ///< [m²] mean square of what else departs there and has no cause
  bool leaves_more = false;   ///< whether that is more than it takes, so that it is not, though it paid

  /// [m²] Mean square of what it takes of the residuals and the others leave.
  ///
  /// @param noise  [m] of ranges
  double square(double noise) const { return std::pow(look.visible * noise, 2); }
};

struct Diagnosis {
  Refinement before;  ///< without any terms
  Refinement after;   ///< with those that were accepted
  std::vector<Departure> departures;
  /// Of candidates with a form, by name, what else was tried. `after` counts on it.
  std::map<std::string, std::vector<Candidate::OtherForm>> other_forms;
  /// A candidate of which these data tell little.
  struct Limit {
    std::string name;
    double size = 0;          ///< [m] RMS change of ranges that would not be seen; may be infinite
    std::string combination;  ///< that is known instead: see known_instead()
  };
  std::vector<Limit> unobservable;
  std::vector<std::string> unshared;  ///< terms that were not looked for: recordings cannot share them
  std::size_t looks = 0;              ///< different things that were looked for
  bool settled = false;               ///< whether a last look at the extended model asked for nothing else
  SideBySide left_before;
  SideBySide left_after;
};

/// Told what is done, and how much of it; returns whether to go on.
using DiagnosisReporter = std::function<bool(double fraction, const std::string& what)>;

/// Looks for what the model of the sensor lacks: refines it, looks at all terms that could be added (score
/// tests), adds those that are needed, and so on until nothing is missing. What does not pay on held-out
/// turns of the plate is left out again, and so is a cause that takes less than what departs from the
/// extended model all the same: it may be no more than a part of that.
///
/// @param start   right to some centimetres and degrees
/// @param sample  all beams; need not be covered
/// @throws Error  as refine_by_surfels() does
Diagnosis diagnose(const SensorModel& start, const Sample& sample, const TermRegistry& terms,
                   const DiagnosisSettings& settings, const DiagnosisReporter& report = {});

}  // namespace crisp
