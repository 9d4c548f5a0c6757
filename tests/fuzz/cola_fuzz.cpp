// SPDX-License-Identifier: BSD-3-Clause
// CoLa streams: what is found does not depend on how the stream is cut, and a scan that could be read can be
// written and read again.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "grabbers/wire/cola_framer.hpp"
#include "grabbers/wire/scan_conversion.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;

struct Found {
  ColaLanguage language;
  Bytes payload;
  bool operator==(const Found&) const = default;
};

std::vector<Found> find(ByteView stream, std::size_t piece) {
  std::vector<Found> found;
  ColaFramer framer;
  const auto take = [&](const ColaFrame& frame) {
    found.push_back({frame.language, Bytes(frame.payload.begin(), frame.payload.end())});
  };
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    framer.feed(stream.subspan(at, std::min(piece, stream.size() - at)), static_cast<std::int64_t>(at), take);
  }
  framer.gap(take);
  if (framer.waiting_since()) std::abort();
  return found;
}

void read_and_write_again(const Found& found) {
  const auto telegram = parse_cola(found.payload, found.language);
  if (!telegram) return;
  cola_error_code(*telegram);
  ScanData data, again;
  if (decode_scan_data(*telegram, EncoderWidths::Position32, data) != FieldFailure::None) return;
  Scan scan;
  to_scan(data, 0, 0, scan);
  data.appended = 0;
  Bytes frame;
  append_scan_data(data, ColaLanguage::B, "sSN", EncoderWidths::Position32, frame);
  const auto whole = find(frame, frame.size());
  if (whole.size() != 1) std::abort();
  const auto parsed = parse_cola(whole[0].payload, ColaLanguage::B);
  if (decode_scan_data(*parsed, EncoderWidths::Position32, again) != FieldFailure::None) std::abort();
  Bytes frame_again;
  append_scan_data(again, ColaLanguage::B, "sSN", EncoderWidths::Position32, frame_again);
  if (frame != frame_again) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView stream(data, size);
  const auto whole = find(stream, size + 1);
  if (find(stream, 1 + size / 7) != whole) std::abort();
  if (size < 2000 && find(stream, 1) != whole) std::abort();
  for (const auto& found : whole) read_and_write_again(found);
  return 0;
}

}  // namespace crisp
