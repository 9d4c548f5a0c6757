// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>

#include <crisp/scan.hpp>

#include "pipeline/clocks/hub_forward_step.hpp"

namespace crisp::clock {

/// A scan or an encoder reading, as the hub received it.
using Received = std::variant<std::shared_ptr<const Scan>, PlateReading>;

std::int64_t receipt_of(const Received& item);       ///< [ns since the Unix epoch]
std::size_t device_of(const Received& item);         ///< its number: 0 for the plate, then the lasers
clocks::DeviceStamp stamp_of(const Received& item);  ///< receipt and the device's time of sending

/// Subtracts a step of the hub's clock from the receipt.
void set_back(Received& item, std::int64_t step_ns);

}  // namespace crisp::clock
