// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <crisp/live_settings.hpp>

#include "grabbers/devices/device_log.hpp"
#include "grabbers/live/endpoints.hpp"
#include "grabbers/wire/plate_framer.hpp"

namespace crisp::live {

/// From the plate's bytes, however they came, to its readings.
class PlateReadings {
 public:
  PlateReadings(devices::DeviceLog& log, GiveItem give, HubClock clock, wire::PlateFramer framer)
      : log_(log), give_(std::move(give)), clock_(std::move(clock)), framer_(std::move(framer)) {}

  /// Bytes that came just now. @return whether there was a reading in them
  bool take(wire::ByteView bytes);
  /// The datagram or connection is over: reports incomplete and damaged data.
  void gap();
  void note(const std::string& what) { log_.note(what); }

 private:
  void take(const PlateReading& reading);

  devices::DeviceLog& log_;
  GiveItem give_;
  HubClock clock_;
  wire::PlateFramer framer_;
};

/// Receives the plate's sentences, in the thread that runs the io_context.
class PlateReceiver {
 public:
  PlateReceiver() = default;
  PlateReceiver(const PlateReceiver&) = delete;
  PlateReceiver& operator=(const PlateReceiver&) = delete;
  virtual ~PlateReceiver() = default;

  virtual void start() = 0;
  virtual void stop() = 0;
  /// The hub's port that datagrams are taken at; 0 for the other transports.
  virtual std::uint16_t port() const { return 0; }
};

/// For datagrams it listens from now on; those from another address than `plate` are counted, and not read.
/// @throws Error if an address is none, or cannot be listened at. A server or a serial line that is not there
///               is no error: it is tried again and again.
std::unique_ptr<PlateReceiver> make_plate_receiver(boost::asio::io_context& context, PlateReadings readings,
                                                   const Address& plate, const PlateSettings& settings);

}  // namespace crisp::live
