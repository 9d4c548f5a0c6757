// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "grabbers/capture/device_log.hpp"
#include "grabbers/live/sick_dialogue.hpp"
#include "grabbers/wire/hub_item.hpp"

namespace crisp {

struct SickSettings {
  ColaLanguage language = ColaLanguage::B;  ///< that is tried first
  bool start = true;         ///< log in and start the measurement; otherwise only ask for scans
  double reply_timeout = 1;  ///< [s] for a connection, and for each answer
  double silence = 2;        ///< [s] without a scan after which the connection is made anew
  double longest_pause = 5;  ///< [s] between two tries; the first are quicker
  EncoderWidths encoder_widths = EncoderWidths::Position32;
};

/// One laser on the network: connects, finds out its language, asks for scans, and does so again whenever the
/// connection breaks or falls silent. All of it happens in the thread that runs the io_context.
class SickClient {
 public:
  using Give = std::function<void(HubItem)>;

  /// @param give  called for each scan, in the order of receipt
  /// @throws Error if the address is none
  SickClient(boost::asio::io_context& context, DeviceLog& log, const Address& address,
             const SickSettings& settings, Give give);
  SickClient(const SickClient&) = delete;
  SickClient& operator=(const SickClient&) = delete;

  void start();
  /// Ends the scans and the connection, within 50 ms.
  void stop();

 private:
  using Then = void (SickClient::*)();

  void connect();
  void begin_dialogue();
  void ask();
  void not_answered();
  void read();
  void take(std::size_t bytes);
  void take(const ColaFrame& frame);
  void proceed(SickDialogue::Effect effect);
  void await_scan();
  void silent();
  void fail(const std::string& reason);
  void close();
  void say(const Bytes& telegram);
  void wait(double seconds, Then then);

  boost::asio::io_context& context_;
  DeviceLog& log_;
  boost::asio::ip::tcp::endpoint endpoint_;
  SickSettings settings_;
  Give give_;

  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer timer_;
  std::uint64_t connection_ = 0;  ///< what an earlier one still has to say is not heard
  std::uint64_t wait_ = 0;        ///< likewise
  Bytes buffer_;
  ColaFramer framer_;
  std::optional<SickDialogue> dialogue_;
  std::size_t refusals_told_ = 0;
  ColaLanguage language_;  ///< that was understood last
  unsigned languages_tried_ = 0;
  double pause_ = 0;
  std::optional<std::string> over_;  ///< why the connection ends once what was read is taken
  bool stopping_ = false;
};

}  // namespace crisp
