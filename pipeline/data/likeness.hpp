// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/data/findings.hpp"

namespace crisp {

/// One way in which what was measured may differ from what is simulated.
struct LikenessLook {
  std::string covariate;  ///< over which it is looked at: "beam"
  std::string quantity;   ///< what may be off: "noise", "range", "density", "correlation"
  std::string unit;       ///< of the amplitude
  double amplitude = 0;   ///< RMS over the covariate, less what chance makes
  double p_value = 1;     ///< that chance makes as much in any of the looks
};

/// How measured data lie beside those that a model makes.
struct Likeness {
  std::vector<LikenessLook> looks;
  double p_value = 1;  ///< that they are the model's: the least of the looks'
};

/// From looks of which each has the chance of its own alone: each is then the worst of so many independent
/// ones, which is too careful where they see the same.
Likeness corrected(std::vector<LikenessLook> looks);

/// Measured data beside those of the plain simulation, and beside those with what was found. Both have the
/// same looks.
struct ToldApart {
  std::string scope;  ///< "laser1", "plate"
  Likeness before, after;
};

/// Says of all scopes together whether they can be told from the simulated ones, and which do by what.
void add_likeness(const std::vector<ToldApart>& scopes, Findings& to);

/// What neither causes nor the unnamed departures that were found explain, beyond 0.002: each is unnamed,
/// too.
///
/// @param left   beside the law with all that was found
/// @param looks  so many scopes are looked at
void add_left_over(const std::string& scope, const Likeness& left, std::size_t looks, Findings& to);

/// The same of all scopes, with what was found.
void add_left_over(const std::vector<ToldApart>& scopes, Findings& to);

/// A p-value, "p = 0.012".
std::string chance_in_words(double p_value);

/// Whether measured and simulated residuals can be told apart, without and with what was found.
std::string likeness_in_words(const Findings& findings);

}  // namespace crisp
