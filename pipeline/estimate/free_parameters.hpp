// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/sensor_model.hpp>

namespace crisp::estimate {

/// Which parameters a calibration turns, and why it leaves others alone.
struct FreeParameters {
  std::vector<std::size_t> free;  ///< indices into model.values()
  std::vector<Unobservable> unobservable;
};

/// λ, τ, α and η of every laser with measurements, but for the λ of the first of them: a rotation of the
/// whole scanner changes nothing. Terms beyond equation (2) are held, but for the requested ones.
///
/// @param fixed  parameters to be held: "laser1.eta", or "eta" for that of all lasers
/// @param terms  requested terms: "encoder.eccentricity", "laser2.mirror.cone"
/// @param forms  whether shape parameters are free, too: see parameters_of()
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

}  // namespace crisp::estimate
