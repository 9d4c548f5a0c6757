// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include <crisp/live_settings.hpp>

#include "grabbers/devices/device_log.hpp"
#include "grabbers/live/endpoints.hpp"
#include "grabbers/live/restartable_timer.hpp"
#include "grabbers/live/sick_dialogue.hpp"

namespace crisp::live {

/// One laser on the network: connects, detects its language, requests scans, and reconnects whenever the
/// connection breaks or falls silent. All of it happens in the thread that runs the io_context.
class SickClient {
 public:
  /// @param give  called for each scan, in the order of receipt
  /// @throws Error if the address is none
  SickClient(boost::asio::io_context& context, devices::DeviceLog& log, const Address& address,
             SickSettings settings, GiveItem give, HubClock clock);
  SickClient(const SickClient&) = delete;
  SickClient& operator=(const SickClient&) = delete;

  void start();
  /// Ends the scans and the connection, within 50 ms.
  void stop();

 private:
  void connect();
  void begin_dialogue();
  void request_scan();
  void not_answered();
  void read();
  void take(std::size_t bytes);
  void take(const wire::ColaFrame& frame);
  bool take_scan(const wire::ColaFrame& frame);  ///< gives it on, if it is one that did not come before
  void proceed(SickDialogue::Effect effect);
  void await_scan();
  void fail(const std::string& reason);
  void close();
  void send(const wire::Bytes& telegram);
  void note_difference(const Scan& scan);

  boost::asio::io_context& context_;
  devices::DeviceLog& log_;
  boost::asio::ip::tcp::endpoint endpoint_;
  SickSettings settings_;
  GiveItem give_;
  HubClock clock_;

  boost::asio::ip::tcp::socket socket_;
  RestartableTimer alarm_;
  BackOff back_off_;
  std::uint64_t connection_ = 0;  ///< callbacks of an earlier one are ignored
  wire::Bytes buffer_;
  wire::ColaFramer framer_;
  std::optional<SickDialogue> dialogue_;
  std::size_t refusals_reported_ = 0;
  ColaLanguage language_;  ///< that was understood last
  unsigned languages_tried_ = 0;
  bool compared_ = false;            ///< a scan of this connection with the configuration
  std::optional<std::string> over_;  ///< why the connection ends once what was read is taken
  bool stopping_ = false;
};

}  // namespace crisp::live
