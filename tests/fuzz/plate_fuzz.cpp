// SPDX-License-Identifier: BSD-3-Clause
// The plate's sentences: the result does not depend on how the stream is cut, and each reading is encoded as
// an equivalent sentence.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "grabbers/wire/plate_framer.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;

std::vector<PlateReading> find(ByteView stream, std::size_t piece,
                               const std::optional<EncoderLine>& own = {}) {
  std::vector<PlateReading> found;
  PlateFramer framer(own);
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    framer.feed(stream.subspan(at, std::min(piece, stream.size() - at)), 0,
                [&](const PlateReading& reading) { found.push_back(reading); });
  }
  framer.gap();
  if (framer.waiting()) std::abort();
  return found;
}

bool same(const PlateReading& a, const PlateReading& b) {
  return a.sequence == b.sequence && a.device_us == b.device_us && a.count == b.count;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView stream(data, size);
  const auto whole = find(stream, size + 1), pieces = find(stream, 3);
  if (whole.size() != pieces.size()) std::abort();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (!same(whole[i], pieces[i])) std::abort();
    const auto again = find(as_bytes(encode_plate_sentence(whole[i])), 100);
    if (again.size() != 1 || !same(again[0], whole[i])) std::abort();
  }
  const EncoderLine own{.begin = "E", .count_column = 2, .time_column = 1, .checksum = LineChecksum::crc8};
  for (const auto& format : {own, EncoderLine{.separators = " "}}) {
    const auto at_once = find(stream, size + 1, format), bytewise = find(stream, 1, format);
    if (at_once.size() != bytewise.size()) std::abort();
    for (std::size_t i = 0; i < at_once.size(); ++i) {
      if (!same(at_once[i], bytewise[i])) std::abort();
    }
  }
  return 0;
}

}  // namespace crisp
