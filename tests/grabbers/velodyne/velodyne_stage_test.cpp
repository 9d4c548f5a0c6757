// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/velodyne/velodyne_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grabbers/capture/frame_builder.hpp"
#include "grabbers/capture/pcap_writer.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::velodyne;
using namespace crisp::wire;

constexpr double kBlock = 110.592e-6;                            // [s]
constexpr double kTurnsASecond = 10;                             // of the head
constexpr double kRate = -2 * std::numbers::pi * kTurnsASecond;  // [rad/s] of the plate
constexpr double kResolution = 0.01 / 180 * std::numbers::pi;    // [rad] of azimuths

/// Packet k of a head that turns steadily: one return of laser 3 in each block.
std::vector<std::uint8_t> packet(std::size_t k) {
  std::vector<std::uint8_t> bytes(kVelodynePacket, 0);
  for (std::size_t b = 0; b < kVelodyneBlocks; ++b) {
    const double time = static_cast<double>(k * kVelodyneBlocks + b) * kBlock;
    const auto azimuth = static_cast<std::size_t>(std::lround(36'000 * kTurnsASecond * time)) % 36'000;
    std::uint8_t* block = bytes.data() + 100 * b;
    block[0] = 0xFF;
    block[1] = 0xEE;
    block[2] = static_cast<std::uint8_t>(azimuth % 256);
    block[3] = static_cast<std::uint8_t>(azimuth / 256);
    block[4 + 3 * 3] = 100;  // [2 mm]
  }
  const auto us =
      static_cast<std::uint32_t>(std::llround(1e6 * static_cast<double>(k * kVelodyneBlocks) * kBlock));
  for (std::size_t i = 0; i < 4; ++i) bytes[1200 + i] = static_cast<std::uint8_t>(us >> (8 * i));
  bytes[1204] = 0x37;
  bytes[1205] = 0x22;
  return bytes;
}

TEST(VelodyneStage, GivesALongCaptureInPiecesInWhichEachBeamIsPlaced) {
  constexpr std::size_t kPackets = 9000;
  const test::TemporaryFolder folder;
  PcapWriter file(folder / "head.pcap", PcapMode::Replace);
  DatagramSender head({"192.168.1.201", 2368}, {"192.168.1.100", 2368},
                      [&](std::int64_t ns, ByteView frame) { file.write(ns, frame); });
  for (std::size_t k = 0; k < kPackets; ++k)
    head.send(packet(k), 1'700'000'000'000'000'000 + static_cast<std::int64_t>(k) * 1'327'104);
  file.close();
  auto stage =
      test::StageDriver::of<VelodyneStage>({{"file", OptionScalar((folder / "head.pcap").string())}});
  stage.run().rig.lasers.resize(kVelodyneLasers, stage.run().rig.lasers.front());
  stage.feed();
  const auto pieces = stage.given<PlateTrajectory>();
  EXPECT_EQ(pieces.size(), 3U);
  std::size_t beams = 0, unplaced = 0;
  double worst = 0;
  for (const auto& scan : stage.given<Measurements>()) {
    for (const double time : scan->time) {
      ++beams;
      const auto plate =
          std::ranges::find_if(pieces, [&](const auto& piece) { return piece->at(time).has_value(); });
      if (plate == pieces.end()) ++unplaced;
      if (plate != pieces.end()) worst = std::max(worst, std::abs((*plate)->at(time)->angle - kRate * time));
    }
  }
  EXPECT_EQ(beams, kPackets * kVelodyneBlocks);
  EXPECT_LE(unplaced, 1U);  // of the last block, behind its azimuth
  EXPECT_LT(worst, 2 * kResolution);
}

}  // namespace
}  // namespace crisp
