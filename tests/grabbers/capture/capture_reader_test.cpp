// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>

#include <crisp/capture_reader.hpp>

#include "grabbers/capture/loss_warnings.hpp"
#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;
using testing::Contains;
using testing::ElementsAreArray;
using testing::SizeIs;
using testing::StartsWith;

std::vector<Frame> in_link_layer(std::vector<Frame> frames, Bytes (*convert)(ByteView)) {
  for (auto& frame : frames) frame.bytes = convert(frame.bytes);
  return frames;
}

/// The frames with payload that a laser sent, by their index.
std::vector<std::size_t> segments_of(const std::vector<Frame>& frames, std::uint8_t last_byte_of_ip) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& b = frames[i].bytes;
    if (b[23] == 6 && b[29] == last_byte_of_ip && b.size() > 60) found.push_back(i);
  }
  return found;
}

TEST(CaptureReader, GivesEveryItemInTheOrderOfItsReceipt) {
  const Scenario scenario{.scans = 30, .beams = 1081};  // a telegram of two segments
  const auto reading = read_capture(pcap_file(scenario.frames()));
  EXPECT_THAT(reading.items, ElementsAreArray(describe(scenario.items())));
  for (const auto* name : {"laser1", "laser2", "plate"}) {
    EXPECT_EQ(reading.device(name).items, name == std::string("plate") ? 300U : 30U);
    EXPECT_TRUE(reading.device(name).losses.all().empty());
  }
  EXPECT_EQ(reading.device("laser3").items, 0U);
  EXPECT_TRUE(reading.statistics.losses.all().empty());
  EXPECT_EQ(reading.statistics.packets, scenario.frames().size());
  EXPECT_EQ(reading.statistics.file_bytes, pcap_file(scenario.frames()).size());
}

TEST(CaptureReader, ReadsBothLanguages) {
  const Scenario scenario{.language = ColaLanguage::A};
  EXPECT_THAT(read_capture(pcap_file(scenario.frames())).items, ElementsAreArray(describe(scenario.items())));
}

TEST(CaptureReader, FindsTheSameInEveryLinkLayer) {
  const Scenario scenario;
  const auto frames = scenario.frames();
  const auto expected = describe(scenario.items());
  const auto vlan = [](ByteView b) { return with_vlan(b, 0x8100); };
  const auto loopback = [](ByteView b) { return as_loopback(b, 2, ByteOrder::Little); };
  EXPECT_EQ(read_capture(pcap_file(in_link_layer(frames, vlan))).items, expected);
  EXPECT_EQ(read_capture(pcap_file(in_link_layer(frames, as_cooked), {.link_type = 113})).items, expected);
  EXPECT_EQ(read_capture(pcap_file(in_link_layer(frames, as_cooked2), {.link_type = 276})).items, expected);
  EXPECT_EQ(read_capture(pcap_file(in_link_layer(frames, as_raw_ip), {.link_type = 101})).items, expected);
  EXPECT_EQ(read_capture(pcap_file(in_link_layer(frames, loopback), {.link_type = 0})).items, expected);
}

TEST(CaptureReader, FindsTheSameHoweverTelegramsAreCutIntoSegments) {
  Scenario scenario{.scans = 3, .tcp = {.ns_per_byte = 0}};
  const auto expected = describe(scenario.items());
  for (std::size_t segment = 1; segment < 160; ++segment) {
    scenario.tcp.largest_segment = segment;
    ASSERT_EQ(read_capture(pcap_file(scenario.frames())).items, expected) << "segments of " << segment;
  }
}

TEST(CaptureReader, StampsATelegramWithThePacketThatCompletesIt) {
  const Scenario scenario{.scans = 5, .tcp = {.largest_segment = 60}};
  const auto expected = describe(scenario.items());
  auto frames = scenario.frames();
  const auto segments = segments_of(frames, 1);
  const auto repeat = [&](std::size_t i, std::int64_t delay) {
    frames.push_back({frames[i].time_ns + delay, frames[i].bytes});
  };
  for (const auto i : segments) repeat(i, 3 * kNsPerMillisecond);  // every segment once more
  std::stable_sort(frames.begin(), frames.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
  const auto again = read_capture(pcap_file(frames));
  EXPECT_EQ(again.items, expected);
  EXPECT_EQ(again.device("laser1").notes.of("retransmitted TCP segments"), segments.size());
}

TEST(CaptureReader, StampsATelegramThatARetransmissionCompletesWithThat) {
  Scenario scenario{.scans = 5, .beams = 200, .tcp = {.largest_segment = 100}};
  auto frames = scenario.frames();
  const auto segments = segments_of(frames, 1);
  const auto late =
      segments[segments.size() / 2];  // of scan 2: comes 7 ms later, behind everything else of it
  frames[late].time_ns += 7 * kNsPerMillisecond;
  const auto time = frames[late].time_ns;
  std::stable_sort(frames.begin(), frames.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
  auto items = scenario.items();
  for (auto& item : items) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
    if (scan == nullptr || (*scan)->laser != 0 || (*scan)->telegram_counter != 102) continue;
    auto delayed = **scan;
    delayed.receipt_ns = time;
    item = std::make_shared<const Scan>(delayed);
  }
  std::stable_sort(items.begin(), items.end(),
                   [](const auto& a, const auto& b) { return receipt_ns(a) < receipt_ns(b); });
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_THAT(reading.items, ElementsAreArray(describe(items)));
  EXPECT_GT(reading.device("laser1").notes.of("TCP segments out of order"), 0U);
}

TEST(CaptureReader, LosesOneTelegramWithALostSegmentAndNamesIt) {
  const Scenario scenario{.scans = 20, .beams = 541, .tcp = {.largest_segment = 400}};
  auto frames = scenario.frames();
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(segments_of(frames, 1)[8]));
  const auto reading = read_capture(pcap_file(frames));
  auto expected = describe(scenario.items());
  EXPECT_THAT(reading.items, SizeIs(expected.size() - 1));
  EXPECT_TRUE(std::includes(expected.begin(), expected.end(), reading.items.begin(), reading.items.end()) ||
              std::all_of(reading.items.begin(), reading.items.end(), [&](const auto& x) {
                return std::count(expected.begin(), expected.end(), x) == 1;
              }));
  const auto& losses = reading.device("laser1").losses;
  EXPECT_EQ(losses.of("lost telegrams, by their counter"), 1U);
  EXPECT_EQ(losses.of("bytes of TCP missing from the capture"), 400U);
  EXPECT_EQ(losses.of("telegrams cut by a gap or an end"), 1U);
}

TEST(CaptureReader, CountsPacketsThatTheRecordingCutOff) {
  constexpr std::size_t kSnapLength = 96;
  const Scenario scenario{.scans = 20, .beams = 541};
  auto frames = scenario.frames();
  std::uint64_t cut = 0;
  for (auto& frame : frames) {
    if (frame.bytes.size() <= kSnapLength) continue;
    frame.original_size = static_cast<std::uint32_t>(frame.bytes.size());
    frame.bytes.resize(kSnapLength);
    ++cut;
  }
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_GE(cut, 20U);
  EXPECT_EQ(reading.statistics.truncated, cut);
  EXPECT_THAT(loss_warnings(reading.statistics),
              Contains(StartsWith(std::to_string(cut) + " of " + std::to_string(frames.size()))));
}

TEST(CaptureReader, GivesItemsInOrderWhereManySegmentsAreLost) {
  const Scenario scenario{.scans = 150, .beams = 541, .tcp = {.largest_segment = 400}};
  auto frames = scenario.frames();
  auto segments = segments_of(frames, 1);
  std::mt19937_64 random(1);
  std::erase_if(segments, [&](std::size_t) { return random() % 2 == 0; });
  std::ranges::reverse(segments);
  for (const std::size_t lost : segments) frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(lost));
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_EQ(reading.statistics.notes.of("items out of order, since the hub's clock stepped back"), 0U);
  EXPECT_EQ(reading.device("laser1").notes.of("TCP segments out of order"), 0U);
}

TEST(CaptureReader, BeginsAndEndsInMidConnection) {
  const Scenario scenario{.scans = 10, .beams = 541, .tcp = {.largest_segment = 300}, .handshake = false};
  auto frames = scenario.frames();
  const auto expected = describe(scenario.items());
  for (std::size_t drop = 0; drop < 30; ++drop) {
    const auto reading =
        read_capture(pcap_file({frames.begin() + static_cast<std::ptrdiff_t>(drop), frames.end()}));
    ASSERT_LE(reading.items.size(), expected.size());
    ASSERT_GE(reading.items.size(), expected.size() - drop);
    ASSERT_TRUE(std::equal(reading.items.rbegin(), reading.items.rend() - 3, expected.rbegin())) << drop;
  }
}

TEST(CaptureReader, GivesWhatWasThereOfAFileCutAnywhere) {
  const Scenario scenario{.scans = 2};
  const auto file = pcap_file(scenario.frames());
  const auto expected = describe(scenario.items());
  std::size_t before = 0;
  for (std::size_t cut = 24; cut <= file.size(); ++cut) {
    const auto reading = read_capture(ByteView(file).first(cut));
    ASSERT_GE(reading.items.size(), before);
    ASSERT_TRUE(std::equal(reading.items.begin(), reading.items.end(), expected.begin())) << cut;
    before = reading.items.size();
  }
  EXPECT_EQ(before, expected.size());
}

TEST(CaptureReader, NeverGivesAWrongItemWhicheverBitFlips) {
  const Scenario scenario{.scans = 4, .beams = 15};
  const auto file = pcap_file(scenario.frames());
  const auto lines = describe(scenario.items());
  // What an item holds; its time may be wrong by less than a second, where a flip in a stamp cannot be seen.
  const auto content = [](const std::string& line) { return line.substr(line.find(' ')); };
  std::set<std::string> known;
  for (const auto& line : lines) known.insert(content(line));
  for (std::size_t bit = 24 * 8; bit < file.size() * 8; bit += 3) {
    auto damaged = file;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    const auto reading = read_capture(damaged);
    ASSERT_GE(reading.items.size() + 1, lines.size()) << "bit " << bit;
    for (const auto& item : reading.items)
      ASSERT_EQ(known.count(content(item)), 1U) << item << ", bit " << bit;
  }
}

}  // namespace
}  // namespace crisp
