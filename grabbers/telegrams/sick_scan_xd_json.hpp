// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <string>

#include <crisp/capture_statistics.hpp>

#include "grabbers/wire/bytes.hpp"

namespace crisp::telegrams {

/// Bytes that came together.
struct ListedTelegram {
  std::int64_t time_ns = 0;  ///< since the recording began
  wire::Bytes bytes;         ///< with their framing
};

/// Reads telegrams as pcap_json_converter of SICK's driver sick_scan_xd writes them for its emulator: a JSON
/// array, of each element `_source.layers.tcp` with `tcp.payload`, hexadecimal with colons, and
/// `Timestamps.tcp.time_relative` [s]. Both sides of the dialogue are in it. Memory does not depend on how
/// many there are.
///
/// @param name    of the file, for errors
/// @param losses  receives elements that cannot be read, by reason
/// @param use     is given each telegram, in the order of the list
/// @throws Error  for what is no JSON, with its line and column, or no array, or has an element of more than
/// 64 MiB
void read_telegram_list(std::istream& text, const std::string& name, Counts& losses,
                        const std::function<void(ListedTelegram)>& use);

}  // namespace crisp::telegrams
