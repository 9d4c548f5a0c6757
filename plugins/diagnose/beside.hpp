// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plugins/diagnose/dictionary.hpp"
#include "plugins/diagnose/looks.hpp"

namespace crisp {

/// The equations as they would be seen from a model whose candidates are all neutral.
NormalEquations from_neutral(const Dictionary& dictionary, NormalEquations equations);

/// Where the base and the candidates in `taken` are estimated with whatever is looked at.
NormalEquations beside_base(const std::vector<std::size_t>& taken, const Dictionary& dictionary,
                            const NormalEquations& equations);

/// Looks at some candidates at once. A form that was chosen among several is a parameter, too, and has its
/// price in the BIC.
///
/// @param left  see beside_base()
Look look_together(const std::vector<std::size_t>& some, const Dictionary& dictionary,
                   const NormalEquations& left);

/// Looks at all candidates, where those in `taken` are there, too: at all but them and other forms of them.
///
/// @param left  see beside_base()
std::vector<std::optional<Look>> looks_in(const NormalEquations& left, const std::vector<std::size_t>& taken,
                                          const Dictionary& dictionary);
std::vector<std::optional<Look>> looks_beside(const std::vector<std::size_t>& taken,
                                              const Dictionary& dictionary, const NormalEquations& equations);

/// Of a candidate that is hardly seen beside the base and those in `taken`: the combinations of its
/// parameters with theirs that are known instead (see known_with()). Empty where they do not do nearly all
/// that it could: the surfaces' planes do, or the data are few.
std::string known_instead(std::size_t candidate, const std::vector<std::size_t>& taken,
                          const Dictionary& dictionary, const NormalEquations& equations);

}  // namespace crisp
