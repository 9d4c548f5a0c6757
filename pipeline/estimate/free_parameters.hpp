// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/model/sensor_model.hpp"

namespace crisp {

/// Which parameters a calibration turns, and why it leaves others alone.
struct FreeParameters {
  std::vector<std::size_t> free;  ///< indices into model.values()
  std::vector<Unobservable> unobservable;
};

/// λ, τ, α and η of every laser that measured something, but for the λ of the first of them: turning the
/// whole scanner changes nothing. Terms beyond equation (2) are left as they are, but for those that are
/// wanted.
///
/// @param fixed  those to be left alone: "laser1.eta", or "eta" for that of all lasers
/// @param terms  to be found as well: "encoder.eccentricity", "laser2.mirror.cone"
/// @param forms  whether what says their form is, too: see parameters_of()
FreeParameters free_parameters(const SensorModel& model, const Measurements& beams,
                               const std::vector<std::string>& fixed,
                               const std::vector<std::string>& terms = {}, bool forms = false);

/// @throws Error  if an entry of `fixed` names no parameter of these lasers
void check_fixed(const std::vector<std::string>& fixed, const Calibration& calibration);

/// The largest and smallest η of the lasers [s], with a margin to both sides.
struct LagRange {
  double earliest = 0;
  double latest = 0;
};
LagRange lag_range(const SensorModel& model, double margin);

}  // namespace crisp
