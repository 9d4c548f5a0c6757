// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/devices/device_log.hpp"
#include "grabbers/wire/cola_framer.hpp"
#include "grabbers/wire/plate_framer.hpp"

namespace crisp::devices {

/// Adds what a framer found damaged in a device's bytes to the device's losses.
void note_framing(const wire::ColaFramer::Counts& counts, DeviceLog& log);
void note_framing(const wire::PlateFramer::Counts& counts, DeviceLog& log);

}  // namespace crisp::devices
