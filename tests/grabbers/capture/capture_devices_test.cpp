// SPDX-License-Identifier: BSD-3-Clause
// The devices in a capture: whose packets are whose, and what each device's own counters and clock show.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crisp/capture_reader.hpp>
#include <crisp/error.hpp>

#include "grabbers/wire/plate_sentence.hpp"
#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;
using testing::ElementsAreArray;
using testing::SizeIs;

/// A telegram of CoLa-A as SICK's telegram listing has it, with an encoder: five beams of 1.5 m.
std::string telegram_with_encoder(unsigned k, std::uint32_t position) {
  return fmt::format(
      "\2sSN LMDscandata 0 1 ABCDE 0 0 {:X} {:X} {:X} {:X} 0 0 0 0 0 9C4 168 1 {:X} 0 1 DIST1 3F800000 00000000 "
      "FFF92230 1388 5 5DC 5DC 5DC 5DC 5DC 0 0 0 0 0 0\3",
      k, 100 + k, 1'000'000 + 40'000 * k, 1'012'345 + 40'000 * k, position);
}

TEST(CaptureDevices, ReadsThePlatesCountsInALasersTelegrams) {
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

TEST(CaptureDevices, ReadsEncoderLinesOfTheRigsFormatInDatagramsAndStreams) {
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

TEST(CaptureDevices, CountsAndNamesDevicesThatTheRigDoesNotKnow) {
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

TEST(CaptureDevices, KnowsDevicesByPortWhereTheRigGivesOne) {
  auto rig = default_rig();
  rig.lasers[0].address.port = 2112;
  rig.lasers[1].address.port = 2111;
  const TemporaryFolder folder;
  write_file(folder / "a.pcap", pcap_file(Scenario().frames()));
  const auto reading = read_capture(folder / "a.pcap", rig);
  EXPECT_EQ(reading.device("laser1").items, 10U);
  EXPECT_EQ(reading.device("laser2").items, 0U);
}

TEST(CaptureDevices, RefusesRigsWhoseAddressesAreNoneOrTheSame) {
  const TemporaryFolder folder;
  write_file(folder / "a.pcap", pcap_file({}));
  auto rig = default_rig();
  rig.lasers[1].address.ip = "laser2";
  EXPECT_THROW(CaptureReader(folder / "a.pcap", rig), Error);
  rig.lasers[1].address.ip = rig.lasers[0].address.ip;
  EXPECT_THROW(CaptureReader(folder / "a.pcap", rig), Error);
}

TEST(CaptureDevices, CountsTelegramsByTheirWholeName) {
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

TEST(CaptureDevices, GivesReadingsOnceThatWereCapturedTwice) {
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

TEST(CaptureDevices, TakesSeveralSentencesOfADatagramAndTheSameBytesOverTcp) {
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

TEST(CaptureDevices, CountsLostReadingsAndDamagedSentences) {
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

TEST(CaptureDevices, NamesTheRestartOfADeviceAndItsSilence) {
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

TEST(CaptureDevices, GivesAllOfARecordingThatWasAppendedToAnother) {
  const Scenario scenario{.scans = 30, .beams = 541};
  const auto reading = read_capture(pcap_file(recorded_twice(scenario, 3600'000 * kNsPerMillisecond)));
  EXPECT_THAT(reading.items, SizeIs(2 * scenario.items().size()));
  for (const auto* name : {"laser1", "laser2"}) {
    EXPECT_EQ(reading.device(name).items, 60U);
    EXPECT_EQ(reading.device(name).notes.of("retransmitted TCP segments"), 0U);
  }
}

TEST(CaptureDevices, TakesAPauseBetweenRecordingsForNoLoss) {
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

TEST(CaptureDevices, TakesTheSilenceOfOneDeviceForALoss) {
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

TEST(CaptureDevices, InspectsACaptureWithoutARig) {
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
