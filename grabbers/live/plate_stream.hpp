// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/live/plate_receiver.hpp"

namespace crisp::live {

/// The rig's plate is a TCP server (port 4000 unless the rig names one) that sends its sentences to whoever
/// connects. A connection that breaks or falls silent is made anew. @throws Error if the address is none
std::unique_ptr<PlateReceiver> plate_over_tcp(boost::asio::io_context& context, PlateReadings readings,
                                              const Address& plate, const PlateSettings& settings);

/// The plate is at a serial line. A line that is not there, fails or falls silent is opened anew.
std::unique_ptr<PlateReceiver> plate_over_serial_line(boost::asio::io_context& context,
                                                      PlateReadings readings, const PlateSettings& settings);

}  // namespace crisp::live
