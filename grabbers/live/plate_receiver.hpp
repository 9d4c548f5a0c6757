// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "grabbers/capture/device_log.hpp"
#include "grabbers/wire/hub_item.hpp"
#include "grabbers/wire/plate_framer.hpp"

namespace crisp {

struct PlateSettings {
  std::string listen = "127.0.0.1";   ///< the hub's address that datagrams are taken at; 0.0.0.0: all of them
  std::optional<std::uint16_t> port;  ///< of the hub; 0: any that is free; nothing: the rig's, or 4000
};

/// Takes the plate's sentences from UDP datagrams, in the thread that runs the io_context.
class PlateReceiver {
 public:
  using Give = std::function<void(HubItem)>;

  /// Listens from now on. Datagrams from another address than `plate` are counted, and not read.
  /// @throws Error if an address is none, or cannot be listened at
  PlateReceiver(boost::asio::io_context& context, DeviceLog& log, const Address& plate,
                const PlateSettings& settings, Give give);
  PlateReceiver(const PlateReceiver&) = delete;
  PlateReceiver& operator=(const PlateReceiver&) = delete;

  std::uint16_t port() const { return port_; }
  void start() { receive(); }
  void stop();

 private:
  void receive();
  void take(std::size_t bytes);

  DeviceLog& log_;
  boost::asio::ip::address plate_;
  Give give_;
  boost::asio::ip::udp::socket socket_;
  std::uint16_t port_ = 0;
  boost::asio::ip::udp::endpoint from_;
  Bytes buffer_;
  PlateFramer framer_;
};

}  // namespace crisp
