// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "plugins/diagnose/dictionary.hpp"
#include "plugins/diagnose/looks.hpp"

namespace crisp {

struct SelectionSettings {
  double bic = 10;         ///< least by which squares must fall beyond the price of parameters
  double p_value = 1e-3;   ///< greatest, after correction for the number of looks
  double visible = 0.015;  ///< [σ] least RMS change of ranges that is seen: edges and bumps make less
  double odds = 9.2;       ///< difference in BIC below which two causes are not told apart (100 to 1)
  std::size_t most = 12;   ///< candidates that are taken
};

/// Another candidate that could stand in the place of one that was taken.
struct Alternative {
  std::size_t candidate = 0;
  double behind = 0;  ///< by how much its BIC is less, in units in which beams' errors are independent
};

/// A candidate that the data ask for.
struct Choice {
  std::size_t candidate = 0;
  Look look;                              ///< at it, where all the others that were taken are there
  std::vector<Alternative> alternatives;  ///< the nearest first, one form of each
};

/// Which candidates a model needs: forward by BIC, each time followed by leaving out what has become needless
/// (stepwise selection), on the linearised problem. What befalls all lasers alike hardly shows as long as one
/// of them alone is mended, so that the same cause of all is tried at once as well. The significance by the
/// recording's blocks is asked of those only that the model has: the blocks of the others scatter by the very
/// effect.
///
/// @param equations  in the dictionary's parameters, with blocks, where the model is
/// @param refused    names of candidates that are not to be taken
/// @param looks      different things that were looked for, if some of them are not in the dictionary any
/// more
/// @return  in the order in which they were taken
std::vector<Choice> choose(const Dictionary& dictionary, const NormalEquations& equations,
                           const SelectionSettings& settings, const std::set<std::string>& refused = {},
                           std::size_t looks = 0);

}  // namespace crisp
