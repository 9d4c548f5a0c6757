// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/address.hpp>
#include <cstdint>
#include <functional>

#include "grabbers/wire/hub_item.hpp"
#include "pipeline/data/rig.hpp"

namespace crisp {

/// Receives a device's items, in the order of receipt.
using GiveItem = std::function<void(HubItem)>;

/// [ns since the Unix epoch] The hub's clock.
using HubClock = std::function<std::int64_t()>;

/// @throws Error if the text is no IP address
boost::asio::ip::address ip_of(const Address& address);

/// [ns since the Unix epoch] This machine's clock.
std::int64_t now_ns();

}  // namespace crisp
