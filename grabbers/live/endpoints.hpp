// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/address.hpp>
#include <cstdint>

#include "pipeline/data/rig.hpp"

namespace crisp {

/// @throws Error if the text is no IP address
boost::asio::ip::address ip_of(const Address& address);

/// [ns since the Unix epoch] The hub's clock.
std::int64_t now_ns();

}  // namespace crisp
