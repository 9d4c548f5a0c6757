// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/plate_receiver.hpp"

#include "grabbers/devices/framing_losses.hpp"
#include "grabbers/live/plate_datagrams.hpp"
#include "grabbers/live/plate_stream.hpp"

namespace crisp::live {

bool PlateReadings::take(wire::ByteView bytes) {
  bool any = false;
  framer_.feed(bytes, clock_(), [&](const PlateReading& reading) {
    any = true;
    take(reading);
  });
  return any;
}

void PlateReadings::take(const PlateReading& reading) {
  if (const auto fresh = log_.take(reading)) give_(*fresh);
}

void PlateReadings::gap() {
  framer_.gap([&](const PlateReading& reading) { take(reading); });
  const wire::PlateFramer::Counts counts = framer_.take_counts();
  if (counts.any_damage()) devices::note_framing(counts, log_);
}

std::unique_ptr<PlateReceiver> make_plate_receiver(boost::asio::io_context& context, PlateReadings readings,
                                                   const Address& plate, const PlateSettings& settings) {
  switch (settings.transport) {
    case PlateTransport::Tcp:
      return plate_over_tcp(context, std::move(readings), plate, settings);
    case PlateTransport::Serial:
      return plate_over_serial_line(context, std::move(readings), settings);
    case PlateTransport::Datagrams:
      break;
  }
  return std::make_unique<PlateDatagrams>(context, std::move(readings), plate, settings);
}

}  // namespace crisp::live
