// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/stamps.hpp"

namespace crisp {

/// Receipt less device time about the straight line below all telegrams, with the least of each stretch, and
/// what was found in these. Lines break in pauses.
///
/// @param departure  with its instant since the first stamp
Plot clock_plot(const std::string& device, std::span<const CountedStamp> stamps,
                const std::optional<ClockDeparture>& departure);

/// The period of a mirror in the course of a recording, beside the nominal one [s].
Plot mirror_plot(const std::string& device, const MirrorFacts& facts, double nominal);

}  // namespace crisp
