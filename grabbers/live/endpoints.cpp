// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/endpoints.hpp"

#include <chrono>

#include <crisp/error.hpp>

namespace crisp::live {

boost::asio::ip::address ip_of(const Address& address) {
  boost::system::error_code failure;
  auto ip = boost::asio::ip::make_address(address.ip, failure);
  if (failure) throw Error("\"" + address.ip + "\" is no IP address", "write it like 192.168.0.1");
  return ip;
}

}  // namespace crisp::live

namespace crisp {

std::int64_t now_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace crisp
