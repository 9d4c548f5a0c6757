// SPDX-License-Identifier: BSD-3-Clause
// Captures that were cut, or in which bits were flipped: a clear error, or a sound cloud and a named loss.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/end_to_end/room.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using test::Outcome;
using testing::AnyOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kFileHeader = 24;  // of a pcap file
constexpr std::size_t kRecordHeader = 16;

/// Where the records of a little-endian pcap file begin, and the file's end.
std::vector<std::size_t> borders_of(const std::string& pcap) {
  std::vector<std::size_t> borders;
  std::size_t at = kFileHeader;
  while (at + kRecordHeader <= pcap.size()) {
    borders.push_back(at);
    std::uint32_t length = 0;
    std::memcpy(&length, pcap.data() + at + 8, sizeof length);
    at += kRecordHeader + length;
  }
  borders.push_back(at);
  return borders;
}

/// One second in the room, made once for all tests: 150 scans of few beams and 200 readings in 90 kB.
class Damage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fixture = std::make_unique<test::PipelineFixture>();
    const std::string room = test::write_room(*fixture / "room.yaml").string();
    fixture->simulate("made",
                      {"duration=1s", "lasers.step=5deg", "encoder.frequency=200Hz", "scene_file=" + room});
    capture = test::bytes_of(*fixture / "made/hub.pcap");
    borders = borders_of(capture);
    points = fixture->assemble("made", "whole").cloud->size();
  }
  static void TearDownTestSuite() { fixture.reset(); }

  static Outcome assemble(const std::string& bytes) {
    test::put_bytes(*fixture / "damaged.pcap", bytes);
    return fixture->assemble("made", "out", *fixture / "damaged.pcap");
  }

  /// Either an error and nothing written, or a cloud that lies on the walls as the whole one does.
  static void expect_sound(const Outcome& outcome, const std::string& what) {
    SCOPED_TRACE(what);
    EXPECT_THAT(outcome.files, Each(Not(HasSubstr(".part"))));
    if (outcome.status == ExitStatus::failed) {
      EXPECT_THAT(outcome.console, HasSubstr("error: "));
      EXPECT_THAT(outcome.files, ElementsAre("summary.json")) << "which reports it";
      return;
    }
    ASSERT_THAT(outcome.status, AnyOf(ExitStatus::done, ExitStatus::not_trusted));
    EXPECT_EQ(outcome.status == ExitStatus::not_trusted,
              outcome.console.find("untrusted: ") != std::string::npos);
    ASSERT_NE(outcome.cloud, nullptr);
    EXPECT_LE(outcome.cloud->size(), points);
    if (outcome.status == ExitStatus::not_trusted) return;
    const auto deviations = test::against_room(*outcome.cloud, {0.2, 0.2, 0.2});
    EXPECT_LT(test::rms(deviations, [](const auto& each) { return each.distance; }), 0.02) << outcome.console;
  }

  static inline std::unique_ptr<test::PipelineFixture> fixture;
  static inline std::string capture;
  static inline std::vector<std::size_t> borders;
  static inline std::size_t points = 0;  ///< of the whole capture's cloud
};

TEST_F(Damage, ACaptureThatIsCutAtOrNextToTheBorderOfAPacketGivesWhatCameBefore) {
  for (std::size_t i = 0; i < borders.size(); i += i < 30 ? 1 : 23) {
    for (const int given : {-1, 0, 1}) {
      const std::size_t end = borders[i] + static_cast<std::size_t>(given);
      if (end > capture.size()) continue;
      const Outcome outcome = assemble(capture.substr(0, end));
      expect_sound(outcome, "cut at " + std::to_string(end));
      if (outcome.status != ExitStatus::done) continue;
      const auto cut_off =
          outcome.count("grabber.capture", "bytes of a record truncated by the end of the file");
      EXPECT_EQ(cut_off, end - *std::prev(std::upper_bound(borders.begin(), borders.end(), end)));
    }
  }
}

TEST_F(Damage, ACaptureThatIsCutAnywhereGivesWhatCameBefore) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> anywhere(0, capture.size());
  for (int i = 0; i < 100; ++i) {
    const std::size_t end = anywhere(random);
    const Outcome outcome = assemble(capture.substr(0, end));
    expect_sound(outcome, "cut at " + std::to_string(end));
    if (end < capture.size() / 2) continue;
    EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  }
}

TEST_F(Damage, FlippedBitsAnywhereLeaveASoundCloudOrAnError) {
  std::mt19937 random(2);
  std::uniform_int_distribution<std::size_t> anywhere(0, capture.size() * 8 - 1);
  for (int i = 0; i < 150; ++i) {
    std::string damaged = capture;
    const int flips = 1 << (i % 6);
    for (int k = 0; k < flips; ++k) {
      const std::size_t bit = anywhere(random);
      damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    }
    expect_sound(assemble(damaged), "flips " + std::to_string(i));
  }
}

TEST_F(Damage, FilesThatAreNoCapturesAreRefused) {
  for (const std::string& bytes : {std::string(), std::string("hello"), std::string(5000, '\0'),
                                   test::bytes_of(*fixture / "made/truth.yaml"), capture.substr(24)}) {
    const Outcome outcome = assemble(bytes);
    EXPECT_EQ(outcome.status, ExitStatus::failed);
    EXPECT_THAT(outcome.console, HasSubstr("error: grabber.capture: "));
    EXPECT_THAT(outcome.files, ElementsAre("summary.json")) << "which reports it";
  }
}

}  // namespace
}  // namespace crisp
