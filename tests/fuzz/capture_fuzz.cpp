// SPDX-License-Identifier: BSD-3-Clause
// Captures: whatever the bytes are, either an Error, or scans and readings that make sense.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <crisp/capture_reader.hpp>
#include <crisp/error.hpp>

#include "tests/fuzz/memory_file.hpp"

namespace {

void check(const crisp::Scan& scan) {
  if (!std::isfinite(scan.start_angle) || !std::isfinite(scan.angle_step) || scan.laser > 2) std::abort();
  for (const auto& echo : scan.echoes) {
    if (echo.ranges.size() != scan.echoes.front().ranges.size()) std::abort();
    if (!echo.remissions.empty() && echo.remissions.size() != echo.ranges.size()) std::abort();
    for (const auto range : echo.ranges) {
      if (!(range >= 0) || std::isinf(range)) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const crisp::MemoryFile input({data, size});
  try {
    crisp::CaptureReader reader(input.path(), crisp::default_rig());
    std::uint64_t items = 0;
    for (; const auto item = reader.next(); ++items) {
      if (const auto* scan = std::get_if<std::shared_ptr<const crisp::Scan>>(&*item)) check(**scan);
    }
    std::uint64_t counted = 0;
    for (const auto& device : reader.statistics().devices) counted += device.name.empty() ? 0 : device.items;
    if (counted != items) std::abort();
  } catch (const crisp::Error&) {
    return 0;
  }
  return 0;
}
