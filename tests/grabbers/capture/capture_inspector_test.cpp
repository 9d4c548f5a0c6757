// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_inspector.hpp"

#include <gmock/gmock.h>

#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;
using testing::HasSubstr;

TEST(CaptureInspector, RecognisesCapturesByTheirBegin) {
  const auto inspector = capture_inspector();
  for (const auto order : {ByteOrder::Little, ByteOrder::Big}) {
    EXPECT_TRUE(inspector.recognises(as_text(pcap_file({}, {order, true}))));
    EXPECT_TRUE(inspector.recognises(as_text(pcap_file({}, {order, false}))));
    EXPECT_TRUE(inspector.recognises(as_text(PcapngBuilder(order).section().bytes())));
  }
  for (const auto* text : {"", "# .PCD v0.7", "crisp: 1"}) EXPECT_FALSE(inspector.recognises(text));
}

TEST(CaptureInspector, NamesDevicesAsTheRigDoes) {
  const MemoryFile file(pcap_file(Scenario().frames()));
  auto rig = default_rig();
  rig.lasers[0].name = "left";
  rig.lasers[1].address.ip = "10.0.0.7";
  const auto inspection = capture_inspector().inspect(file.path(), rig);
  EXPECT_THAT(inspection.text,
              testing::AllOf(HasSubstr("left (192.168.0.1:2112)"), HasSubstr("laser at 192.168.0.2"),
                             HasSubstr("plate (192.168.0.10:4000)")));
  ASSERT_EQ(inspection.data["devices"].size(), 3U) << "what the rig has and the capture lacks is not listed";
  EXPECT_EQ(inspection.data["devices"][0]["name"], "left");
  EXPECT_THAT(inspection.text, HasSubstr("nothing of the rig's laser2 (10.0.0.7), laser3 (192.168.0.3)"));
  EXPECT_EQ(inspection.data["missing"].size(), 2U);
}

TEST(CaptureInspector, FindsAnEncodersOwnLinesByTheRig) {
  std::vector<Frame> frames;
  DatagramSender plate(kPlate, kHubPlate, into(frames));
  for (const int k : {0, 1, 2})
    plate.send(as_bytes("10," + std::to_string(7 - 2 * k) + "\n"), kStart + k * 1'000'000);
  const MemoryFile file(pcap_file(frames));
  auto rig = default_rig();
  EXPECT_TRUE(capture_inspector().inspect(file.path(), rig).data["devices"].empty());
  rig.plate.line = EncoderLine{.count_column = 2};
  EXPECT_THAT(capture_inspector().inspect(file.path(), rig).text,
              HasSubstr("encoder: counted 0 up and 4 down"));
  const MemoryFile still(pcap_file({frames.front(), frames.front()}));
  EXPECT_THAT(capture_inspector().inspect(still.path(), rig).text,
              HasSubstr("encoder: counted 0 up and 0 down: the plate or the encoder stood still"));
}

}  // namespace
}  // namespace crisp
