// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "plugins/diagnose/departure.hpp"
#include "plugins/diagnose/held_out.hpp"

namespace crisp {

/// Fits a calibration, with the terms that it has, to all beams of a sample.
using RefinedOn = std::function<SensorModel(const Calibration& start, const Sample& sample)>;

/// Judges departures by turns of the plate that models were not fitted to: in their order, models with one
/// more each are fitted to the other turns. What all lasers have alike and what does not pay for one of them
/// alone is asked of all of them together: mended in one alone, they disagree.
///
/// @param departures  their gains and whether they are accepted are set, but for those that are refused
/// already
/// @param plain       of the model without any, which the first has to beat
/// @param found       with all of them; where the other fits start
void accept_what_pays(const HeldOut& held_out, std::vector<Departure>& departures,
                      const HeldOut::Score& plain, const Calibration& found, const RefinedOn& refined);

}  // namespace crisp
