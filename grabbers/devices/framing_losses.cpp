// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/framing_losses.hpp"

#include <fmt/format.h>

namespace crisp::devices {

void note_framing(const wire::ColaFramer::Counts& counts, DeviceLog& log) {
  log.lose("telegrams with a wrong checksum", counts.checksum_failures);
  log.lose("telegrams cut by a gap or an end", counts.cut);
  log.lose("bytes outside of whole telegrams", counts.skipped_bytes);
  log.note("resynchronizations on the next telegram", counts.resynchronisations);
}

void note_framing(const wire::PlateFramer::Counts& counts, DeviceLog& log) {
  for (const auto failure :
       {wire::PlateFailure::Truncated, wire::PlateFailure::BadChecksum, wire::PlateFailure::BadField}) {
    log.lose(fmt::format("sentences refused: {}", wire::to_string(failure)), counts.of(failure));
  }
  log.note("sentences of other kinds", counts.of(wire::PlateFailure::OtherSentence));
  log.lose("bytes outside of sentences", counts.skipped_bytes);
}

}  // namespace crisp::devices
