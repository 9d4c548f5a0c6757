// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grabbers/capture/counts.hpp"
#include "grabbers/wire/bytes.hpp"

namespace crisp {

/// Bytes that came together.
struct ListedTelegram {
  std::int64_t time_ns = 0;  ///< since the recording began
  Bytes bytes;               ///< with their framing
};

/// Reads telegrams as pcap_json_converter of SICK's driver sick_scan_xd writes them for its emulator: a JSON
/// array, of each element `_source.layers.tcp` with `tcp.payload`, hexadecimal with colons, and
/// `Timestamps.tcp.time_relative` [s]. Both sides of the dialogue are in it.
///
/// @param name    of the file, for errors
/// @param losses  receives elements that cannot be read, by reason
/// @return        in the order of the list
/// @throws Error  for what is no JSON, with its line and column, or no array
std::vector<ListedTelegram> read_telegram_list(const std::string& text, const std::string& name,
                                               Counts& losses);

}  // namespace crisp
