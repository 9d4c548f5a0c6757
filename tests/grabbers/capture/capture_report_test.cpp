// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_report.hpp"

#include <gmock/gmock.h>

#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using testing::AllOf;
using testing::HasSubstr;

TEST(CaptureReport, DescribesACapture) {
  const MemoryFile file(pcap_file(Scenario{.scans = 20, .beams = 541}.frames()));
  const auto text = to_text(inspect_capture(file.path()));
  EXPECT_THAT(text, AllOf(HasSubstr(" packets, 0.1 MB"), HasSubstr("2023-11-14 22:13:19 UTC"),
                          HasSubstr("Ethernet")));
  EXPECT_THAT(text, AllOf(HasSubstr("laser at 192.168.0.1:2112"), HasSubstr("plate at 192.168.0.10:4000")));
  EXPECT_THAT(text, AllOf(HasSubstr("541 beams from -45 by 0.5 deg"), HasSubstr("serial number 1001"),
                          HasSubstr("20.000 ms a turn"), HasSubstr("17.00 ms after its stamp")));
  EXPECT_THAT(text, AllOf(HasSubstr("20 sSN LMDscandata"), HasSubstr("200 PPLT")));
  EXPECT_THAT(text, HasSubstr("encoder: counted 3184 up and 0 down"));  // 199 times 16
  EXPECT_THAT(text, testing::Not(HasSubstr("lost:")));
}

TEST(CaptureReport, ReportsThatACaptureHoldsNothing) {
  const MemoryFile file(pcap_file({}));
  EXPECT_THAT(to_text(inspect_capture(file.path())), HasSubstr("it holds no laser and no plate"));
}

TEST(CaptureReport, CountsTheSilenceBeforeTheFirstItemAndAfterTheLast) {
  // All laser items of the first half, then readings alone.
  const auto frames = Scenario{.scans = 20}.frames();
  std::vector<Frame> of_plate;
  for (const Frame& frame : frames) {
    const bool is_plate = frame.bytes.size() < 100;
    if (is_plate || 2 * of_plate.size() < frames.size()) of_plate.push_back(frame);
  }
  const MemoryFile whole(pcap_file(frames));
  const MemoryFile cut(pcap_file(of_plate));
  const auto silence_of = [](const MemoryFile& file, DeviceKind kind) {
    double longest = 0;
    for (const auto& device : inspect_capture(file.path()).devices) {
      if (device.kind == kind) longest = std::max(longest, device.longest_silence);
    }
    return longest;
  };
  EXPECT_LT(silence_of(whole, DeviceKind::Laser), 0.03);
  EXPECT_GT(silence_of(cut, DeviceKind::Laser), 0.1);
  EXPECT_LT(silence_of(cut, DeviceKind::Plate), 0.03);
}

TEST(CaptureReport, ReportsPausesBetweenRecordings) {
  const CaptureStatistics statistics{.pauses = 1, .paused = 3595.04};
  EXPECT_THAT(to_text(statistics), HasSubstr("2 recordings in sequence, with 3595.0 s of pauses"));
  EXPECT_EQ(to_json(statistics)["pauses"], 1);
  EXPECT_EQ(to_json(statistics)["paused"], 3595.04);
}

TEST(CaptureReport, HintsAtStampsThatAreATurnLate) {
  CaptureStatistics statistics;
  statistics.devices.push_back({.items = 3, .median_handover = 3.1e-3, .period = 20.1e-3});
  EXPECT_THAT(to_text(statistics), HasSubstr("period_offset: -1"));
  EXPECT_EQ(to_json(statistics)["devices"][0]["period_hint"], -1);
}

}  // namespace
}  // namespace crisp
