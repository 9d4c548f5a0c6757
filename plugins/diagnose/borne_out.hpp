// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "pipeline/estimate/outcome.hpp"
#include "plugins/diagnose/departure.hpp"

namespace crisp {

/// Where each parameter of a candidate's term is among those that were estimated; nothing for those that were
/// not.
std::vector<std::optional<Eigen::Index>> places_of(const Candidate& candidate, const Outcome& outcome);

/// Refuses causes that several lasers have alike where none of them is large: surfaces that are not as flat
/// as they are taken for make as much in all lasers, and many a cause takes a part of that.
void refuse_what_may_be_the_scenes(std::vector<Departure>& departures);

/// Refuses the accepted whose values, as they were estimated with all that are accepted, may as well be
/// neutral (Wald's test, of all parameters of a term but its form): what was needed beside others that were
/// then refused.
///
/// @param p_value  greatest that bears one out
/// @return         whether any was; estimate the others without it, and ask again
bool refuse_what_is_not_borne_out(std::vector<Departure>& departures, const Outcome& outcome,
                                  const TermRegistry& terms, double p_value);

}  // namespace crisp
