// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/udp.hpp>

#include "grabbers/live/plate_receiver.hpp"

namespace crisp::live {

/// The plate's sentences in UDP datagrams.
class PlateDatagrams final : public PlateReceiver {
 public:
  /// As make_plate_receiver().
  PlateDatagrams(boost::asio::io_context& context, PlateReadings readings, const Address& plate,
                 const PlateSettings& settings);

  void start() override { receive(); }
  void stop() override;
  std::uint16_t port() const override { return port_; }

 private:
  void receive();
  void take(std::size_t bytes);

  PlateReadings readings_;
  boost::asio::ip::address plate_;
  boost::asio::ip::udp::socket socket_;
  std::uint16_t port_ = 0;
  boost::asio::ip::udp::endpoint from_;
  wire::Bytes buffer_;
};

}  // namespace crisp::live
