// SPDX-License-Identifier: BSD-3-Clause
// Lists of telegrams: any text gives bytes and times, counted losses, or an error with its place.
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include <crisp/error.hpp>

#include "grabbers/telegrams/sick_scan_xd_json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
  crisp::Counts losses;
  try {
    crisp::telegrams::read_telegram_list(text, "list.json", losses,
                                         [&](const crisp::telegrams::ListedTelegram& telegram) {
                                           if (telegram.time_ns < 0 || telegram.bytes.size() > size)
                                             std::abort();
                                         });
  } catch (const crisp::Error& error) {
    if (error.place().line < 1 || error.place().column < 1) std::abort();
  }
  return 0;
}
