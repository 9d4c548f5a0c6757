// SPDX-License-Identifier: BSD-3-Clause
// Packets of a VLP-16: whatever the bytes are, ranges and azimuths that can be, or nothing.
#include <cstdint>
#include <cstdlib>

#include "grabbers/velodyne/velodyne_packet.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto packet = crisp::velodyne::parse_velodyne(crisp::wire::ByteView(data, size));
  if (!packet) return 0;
  for (const double azimuth : packet->azimuth) {
    if (!(azimuth >= 0 && azimuth < 6.2832)) std::abort();
  }
  for (const auto& block : packet->returns) {
    for (const auto& firing : block) {
      for (const auto& one : firing) {
        if (!(one.range >= 0 && one.range < 132)) std::abort();
      }
    }
  }
  return 0;
}
