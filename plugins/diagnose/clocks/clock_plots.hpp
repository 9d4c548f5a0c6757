// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/clocks/clock_departure.hpp"

namespace crisp::diagnose {

/// Plot of receipt less device time about the fitted clock line, with the lower envelope and the fitted
/// deviation. Lines break at pauses.
///
/// @param departure  its time counts from the first stamp
plot::Plot clock_plot(const std::string& device, std::span<const CountedStamp> stamps,
                      const std::optional<ClockDeparture>& departure);

/// Plot of a mirror's period over the recording, with the nominal period [s].
plot::Plot mirror_plot(const std::string& device, const MirrorFacts& facts, double nominal);

}  // namespace crisp::diagnose
