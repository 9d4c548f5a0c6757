// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "grabbers/wire/cola_framer.hpp"
#include "grabbers/wire/scan_data.hpp"
#include "tests/support/shared_data.hpp"

namespace crisp {

/// The bytes of "02 73 …"; white space is ignored.
wire::Bytes from_hex(std::string_view hex);

/// A real telegram of tests/grabbers/wire/telegrams, framing included.
wire::Bytes real_telegram(std::string_view file);

/// A telegram with every optional block, several encoders and channels; `seed` varies the values.
wire::ScanData full_scan_data(std::uint32_t seed);

/// One telegram found in a stream, with bytes of its own.
struct FoundTelegram {
  ColaLanguage language;
  wire::Bytes payload;
  std::int64_t completed_ns;
  bool operator==(const FoundTelegram&) const = default;
};

/// What a framer finds in a stream fed in pieces of `piece` bytes, piece i arriving at time i; a gap at the
/// end.
std::vector<FoundTelegram> find_telegrams(wire::ByteView stream, std::size_t piece = 1 << 20,
                                          wire::ColaFramer::Counts* counts = nullptr);

}  // namespace crisp
