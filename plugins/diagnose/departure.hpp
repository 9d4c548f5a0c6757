// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "plugins/diagnose/candidates.hpp"
#include "plugins/diagnose/looks.hpp"

namespace crisp {

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
  std::string refused = {};   ///< why it is not part of it; empty: it is, or did not pay

  /// Leaves it out, though it paid or was not asked to.
  void refuse(std::string why) {
    accepted = false;
    refused = std::move(why);
  }

  /// [m²] Mean square of what it takes of the residuals and the others leave.
  ///
  /// @param noise  [m] of ranges
  double square(double noise) const { return std::pow(look.visible * noise, 2); }
};

}  // namespace crisp
