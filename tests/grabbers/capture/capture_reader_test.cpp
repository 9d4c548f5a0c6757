// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include <crisp/capture_reader.hpp>
#include <crisp/error.hpp>

#include "grabbers/wire/plate_sentence.hpp"
#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using testing::ElementsAreArray;
using testing::SizeIs;

constexpr std::int64_t kNsPerMillisecond = 1'000'000;

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

/// A telegram of CoLa-A as SICK's telegram listing has it, with an encoder: five beams of 1.5 m.
std::string telegram_with_encoder(unsigned k, std::uint32_t position) {
  return fmt::format(
      "\2sSN LMDscandata 0 1 ABCDE 0 0 {:X} {:X} {:X} {:X} 0 0 0 0 0 9C4 168 1 {:X} 0 1 DIST1 3F800000 00000000 "
      "FFF92230 1388 5 5DC 5DC 5DC 5DC 5DC 0 0 0 0 0 0\3",
      k, 100 + k, 1'000'000 + 40'000 * k, 1'012'345 + 40'000 * k, position);
}

TEST(CaptureReader, ReadsThePlatesCountsInALasersTelegrams) {
  std::vector<Frame> frames;
  TcpConversation laser(kLaser1, kHub, into(frames));
  laser.open(kStart);
  const std::vector<std::uint32_t> positions = {2, 1, 0, 4294967295, 4294967294};
  for (unsigned k = 0; k < positions.size(); ++k) {
    laser.send(TcpSide::Server, as_bytes(telegram_with_encoder(k, positions[k])),
               kStart + (50 + 40 * k) * kNsPerMillisecond);
  }
  Rig rig = default_rig();
  rig.lasers.resize(1);
  rig.plate.address = {};
  rig.plate.encoder_of = 0;
  const auto reading = read_capture(MemoryFile(pcap_file(frames)).path(), rig);
  ASSERT_EQ(reading.items.size(), 10U);
  EXPECT_EQ(reading.items[0], "50000000 plate 0 1000000 2") << "before the scan that it came with";
  EXPECT_THAT(reading.items[1], testing::StartsWith("50000000 laser 0"));
  EXPECT_EQ(reading.items[6], "170000000 plate 3 1120000 4294967295");
  EXPECT_EQ(reading.device("plate").items, 5U);
  EXPECT_EQ(reading.device("plate").counted_down, 4U);
  EXPECT_EQ(reading.device("laser1").counted_down, 4U) << "for people who look for an encoder";
}

TEST(CaptureReader, ReadsEncoderLinesOfTheRigsFormatInDatagramsAndStreams) {
  Rig rig = default_rig();
  rig.plate.line = EncoderLine{.begin = "ENC", .count_column = 2, .time_column = 1, .time_unit = 1e-3};
  const std::vector<std::string> expected = {"5000000 plate 0 10000 77", "7000000 plate 1 12000 78",
                                             "7000000 plate 2 14000 79"};
  const auto send = [](const auto& sender) {
    sender("ENC 10 77\n", 5 * kNsPerMillisecond);
    sender("ENC 12 78\nENC 14 79\n", 7 * kNsPerMillisecond);
  };
  std::vector<Frame> datagrams;
  DatagramSender udp(kPlate, kHubPlate, into(datagrams));
  send([&](std::string_view text, std::int64_t ns) { udp.send(as_bytes(text), kStart + ns); });
  EXPECT_EQ(read_capture(MemoryFile(pcap_file(datagrams)).path(), rig).items, expected);
  std::vector<Frame> segments;
  TcpConversation tcp(kPlate, kHub, into(segments));
  tcp.open(kStart);
  send([&](std::string_view text, std::int64_t ns) {
    tcp.send(TcpSide::Server, as_bytes(text), kStart + ns);
  });
  EXPECT_EQ(read_capture(MemoryFile(pcap_file(segments)).path(), rig).items, expected);
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

TEST(CaptureReader, CountsAndNamesDevicesThatTheRigDoesNotKnow) {
  auto rig = default_rig();
  rig.lasers.erase(rig.lasers.begin() + 1);
  rig.plate.address = {"192.168.0.77", 4000};
  const Scenario scenario;
  const TemporaryFolder folder;
  write_file(folder / "a.pcap", pcap_file(scenario.frames()));
  const auto reading = read_capture(folder / "a.pcap", rig);
  EXPECT_THAT(reading.items, SizeIs(10)) << "laser1's";
  std::vector<std::string> unknown;
  for (const auto& device : reading.statistics.devices) {
    if (device.name.empty()) unknown.push_back(device.address.ip);
  }
  EXPECT_THAT(unknown, ElementsAreArray({"192.168.0.2", "192.168.0.10"}));
  EXPECT_EQ(reading.statistics.devices[3].items, 10U);
  EXPECT_EQ(reading.statistics.devices[4].items, 100U);
}

TEST(CaptureReader, KnowsDevicesByPortWhereTheRigGivesOne) {
  auto rig = default_rig();
  rig.lasers[0].address.port = 2112;
  rig.lasers[1].address.port = 2111;
  const TemporaryFolder folder;
  write_file(folder / "a.pcap", pcap_file(Scenario().frames()));
  const auto reading = read_capture(folder / "a.pcap", rig);
  EXPECT_EQ(reading.device("laser1").items, 10U);
  EXPECT_EQ(reading.device("laser2").items, 0U);
}

TEST(CaptureReader, RefusesRigsWhoseAddressesAreNoneOrTheSame) {
  const TemporaryFolder folder;
  write_file(folder / "a.pcap", pcap_file({}));
  auto rig = default_rig();
  rig.lasers[1].address.ip = "laser2";
  EXPECT_THROW(CaptureReader(folder / "a.pcap", rig), Error);
  rig.lasers[1].address.ip = rig.lasers[0].address.ip;
  EXPECT_THROW(CaptureReader(folder / "a.pcap", rig), Error);
}

TEST(CaptureReader, CountsTelegramsByTheirWholeName) {
  std::vector<Frame> frames;
  TcpConversation laser(kLaser1, kHub, into(frames));
  const auto send = [&](const char* text, std::int64_t t) {
    laser.send(TcpSide::Server, cola_frame(as_bytes(text), ColaLanguage::A), kStart + t * kNsPerMillisecond);
  };
  send("sSN LMDscandatamon 1 1 1", 1);
  send("sFA 3", 2);
  laser.send(TcpSide::Server, encode_scan_data(numbered_scan(0), ColaLanguage::B),
             kStart + 3 * kNsPerMillisecond);
  send("sSN LMDscandata 1 1 89A27F 0", 4);  // ends too early
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_THAT(reading.items, SizeIs(1));
  const auto& device = reading.device("laser1");
  EXPECT_EQ(device.telegrams.of("sSN LMDscandatamon"), 1U);
  EXPECT_EQ(device.telegrams.of("sSN LMDscandata"), 2U);
  EXPECT_EQ(device.telegrams.of("sFA 3 (unknown variable)"), 1U);
  EXPECT_EQ(device.losses.of("unreadable scan telegrams: the payload is too short for its fields"), 1U);
}

TEST(CaptureReader, GivesReadingsOnceThatWereCapturedTwice) {
  std::vector<Frame> frames;
  DatagramSender plate(kPlate, kHubPlate, into(frames));
  for (std::uint16_t k = 0; k < 20; ++k) {
    plate.send(as_bytes(encode_plate_sentence(numbered_reading(k))), kStart + k * kNsPerMillisecond);
    frames.push_back({kStart + k * kNsPerMillisecond + 5000, frames.back().bytes});  // as on two interfaces
  }
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_THAT(reading.items, SizeIs(20));
  EXPECT_EQ(reading.device("plate").notes.of("items that came twice"), 20U);
}

TEST(CaptureReader, TakesSeveralSentencesOfADatagramAndTheSameBytesOverTcp) {
  std::string sentences;
  for (std::uint16_t k = 0; k < 20; ++k) sentences += encode_plate_sentence(numbered_reading(k));
  std::vector<Frame> frames;
  DatagramSender(kPlate, kHubPlate, into(frames)).send(as_bytes(sentences), kStart);
  EXPECT_THAT(read_capture(pcap_file(frames)).items, SizeIs(20));
  frames.clear();
  TcpConversation(kPlate, kHub, into(frames), {.largest_segment = 17})
      .send(TcpSide::Server, as_bytes(sentences), kStart);
  EXPECT_THAT(read_capture(pcap_file(frames)).items, SizeIs(20));
}

TEST(CaptureReader, CountsLostReadingsAndDamagedSentences) {
  std::vector<Frame> frames;
  DatagramSender plate(kPlate, kHubPlate, into(frames));
  for (std::uint16_t k = 65500; k != 100; ++k) {  // across the wrap
    auto sentence = encode_plate_sentence(numbered_reading(k));
    if (k == 65510) sentence[7] ^= 1;
    if (k == 65511) sentence.resize(12);
    if (k != 20 && k != 21)
      plate.send(as_bytes(sentence), kStart + static_cast<std::uint16_t>(k - 65500) * 2 * kNsPerMillisecond);
  }
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_THAT(reading.items, SizeIs(132));
  const auto& losses = reading.device("plate").losses;
  EXPECT_EQ(losses.of("lost readings, by their sequence number"), 4U);
  EXPECT_EQ(losses.of("sentences refused: a wrong checksum"), 1U);
  EXPECT_EQ(losses.of("sentences refused: a truncated line"), 1U);
}

TEST(CaptureReader, NamesTheRestartOfADeviceAndItsSilence) {
  std::vector<Frame> frames;
  TcpConversation laser(kLaser1, kHub, into(frames));
  for (std::uint16_t k = 0; k < 100; ++k) {
    auto data = numbered_scan(k);
    std::int64_t time = kStart + k * 20 * kNsPerMillisecond;
    if (k >= 50) {
      data = numbered_scan(static_cast<std::uint16_t>(k - 50));
      time += 30'000 * kNsPerMillisecond;
    }
    laser.send(TcpSide::Server, encode_scan_data(data, ColaLanguage::B), time);
  }
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_THAT(reading.items, SizeIs(100));
  const auto& device = reading.device("laser1");
  EXPECT_EQ(device.notes.of("restarts of the device's clock"), 1U);
  EXPECT_EQ(device.losses.of("lost telegrams, by their counter"), 0U);
  EXPECT_NEAR(device.longest_silence, 30.02, 1e-6);
  EXPECT_EQ(device.silence_ns, kStart + 49 * 20 * kNsPerMillisecond);
}

/// Two recordings, one behind the other in a file, each of whose connections begins with the same number.
std::vector<Frame> recorded_twice(const Scenario& scenario, std::int64_t apart_ns) {
  auto frames = scenario.frames();
  auto later = frames;
  for (auto& frame : later) frame.time_ns += apart_ns;
  frames.insert(frames.end(), later.begin(), later.end());
  return frames;
}

TEST(CaptureReader, GivesAllOfARecordingThatWasAppendedToAnother) {
  const Scenario scenario{.scans = 30, .beams = 541};
  const auto reading = read_capture(pcap_file(recorded_twice(scenario, 3600'000 * kNsPerMillisecond)));
  EXPECT_THAT(reading.items, SizeIs(2 * scenario.items().size()));
  for (const auto* name : {"laser1", "laser2"}) {
    EXPECT_EQ(reading.device(name).items, 60U);
    EXPECT_EQ(reading.device(name).notes.of("retransmitted TCP segments"), 0U);
  }
}

TEST(CaptureReader, TakesAPauseBetweenRecordingsForNoLoss) {
  const Scenario scenario{.scans = 30};
  const auto reading = read_capture(pcap_file(recorded_twice(scenario, 3600'000 * kNsPerMillisecond)));
  EXPECT_EQ(reading.statistics.pauses, 1U);
  EXPECT_NEAR(reading.statistics.paused, 3600 - 0.6, 0.1);
  for (const auto* name : {"laser1", "laser2", "plate"}) {
    EXPECT_TRUE(reading.device(name).losses.all().empty()) << name;
  }
  EXPECT_NEAR(reading.device("laser1").rate(), 50, 1e-9);
  EXPECT_NEAR(reading.device("plate").rate(), 500, 1e-9);
}

TEST(CaptureReader, TakesTheSilenceOfOneDeviceForALoss) {
  const Scenario scenario{.scans = 500, .handshake = false};
  auto frames = scenario.frames();
  std::erase_if(frames, [](const Frame& frame) {  // of the plate, for 8 s
    return frame.bytes[29] == 10 && frame.time_ns > kStart + 1000 * kNsPerMillisecond &&
           frame.time_ns < kStart + 9000 * kNsPerMillisecond;
  });
  const auto reading = read_capture(pcap_file(frames));
  EXPECT_EQ(reading.statistics.pauses, 0U);
  EXPECT_EQ(reading.device("plate").losses.of("lost readings, by their sequence number"), 4000U);
}

TEST(CaptureReader, InspectsACaptureWithoutARig) {
  const Scenario scenario{.scans = 40, .beams = 541};
  const TemporaryFolder folder;
  write_file(folder / "a.pcap", pcap_file(scenario.frames()));
  const auto found = inspect_capture(folder / "a.pcap");
  ASSERT_THAT(found.devices, SizeIs(3));
  EXPECT_EQ(found.devices[0].address, kLaser1);
  EXPECT_EQ(found.devices[1].address, kLaser2);
  EXPECT_EQ(found.devices[2].address, kPlate);
  EXPECT_EQ(found.devices[0].kind, DeviceKind::Laser);
  EXPECT_EQ(found.devices[2].kind, DeviceKind::Plate);
  EXPECT_THAT(found.devices[1].serial_numbers, testing::ElementsAre(1001));
  EXPECT_NEAR(found.devices[0].rate(), 50, 1e-9);
  EXPECT_NEAR(found.devices[2].rate(), 500, 1e-9);
  EXPECT_EQ(found.devices[0].shape.beams, 541U);
  EXPECT_NEAR(*found.devices[0].median_handover, 0.017, 1e-9);
  EXPECT_NEAR(*found.devices[0].period, 0.020, 1e-9);
  EXPECT_EQ(found.devices[0].period_hint(), 0) << "17 ms: a scan can be over by then";
}

}  // namespace
}  // namespace crisp
