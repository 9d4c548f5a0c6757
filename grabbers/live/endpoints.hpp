// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/address.hpp>
#include <functional>

#include <crisp/hub_item.hpp>
#include <crisp/live_settings.hpp>
#include <crisp/rig.hpp>

namespace crisp::live {

/// Receives a device's items, in the order of receipt.
using GiveItem = std::function<void(HubItem)>;

/// @throws Error if the text is no IP address
boost::asio::ip::address ip_of(const Address& address);

}  // namespace crisp::live
