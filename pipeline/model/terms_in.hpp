// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/term.hpp>

namespace crisp::model {

/// The terms of a calibration that are of some kind, the plate's first: "encoder.eccentricity",
/// "laser2.mirror.cone".
///
/// @param is_such  predicate that selects terms; without it, all are
/// @throws Error  if a term is not known
std::vector<std::string> terms_in(const Calibration& calibration, const TermRegistry& terms,
                                  const std::function<bool(const TermInfo&)>& is_such = {});

}  // namespace crisp::model
