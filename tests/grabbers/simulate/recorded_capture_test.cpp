// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/recorded_capture.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include <crisp/calibration_file.hpp>
#include <crisp/error.hpp>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/capture/frame_builder.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "grabbers/simulate/truth_file.hpp"
#include "grabbers/wire/cola_framer.hpp"
#include "grabbers/wire/plate_framer.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::simulate;
using namespace crisp::wire;
namespace fs = std::filesystem;

class RecordedCaptureTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("crisp_recorded_capture_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    settings_.scanner.duration = 0.3;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<HubEvent> record(const fs::path& file, const WireFaults& faults = {}) {
    const Scene scene = office();
    RecordingSimulator simulator(settings_, scene);
    RecordedCapture capture(file, settings_, simulator.truth(), faults);
    std::vector<HubEvent> events;
    while (auto event = simulator.next()) {
      capture.write(*event);
      events.push_back(std::move(*event));
    }
    EXPECT_FALSE(fs::exists(file)) << "nothing is there before it is complete";
    capture.close();
    counts_ = capture.faults();
    return events;
  }

  static Bytes read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
  RecordingSettings settings_;
  FaultyWire::Counts counts_;
};

struct Frame {
  std::int64_t time_ns = 0;
  std::uint8_t protocol = 0;  ///< 6 TCP, 17 UDP
  std::uint32_t from = 0;     ///< IPv4 address
  ByteView payload;
};

/// Frames of a little-endian nanosecond pcap of Ethernet and IPv4 without options, by the formats'
/// definitions.
std::vector<Frame> parse(const Bytes& file) {
  std::vector<Frame> frames;
  const auto u32 = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, &file[at], 4);
    return value;
  };
  EXPECT_EQ(u32(0), 0xa1b23c4dU);
  for (std::size_t at = 24; at + 16 <= file.size();) {
    const std::size_t length = u32(at + 8);
    const ByteView bytes = ByteView(file).subspan(at + 16, length);
    Frame frame;
    frame.time_ns = std::int64_t{u32(at)} * 1'000'000'000 + u32(at + 4);
    frame.protocol = bytes[23];
    frame.from = static_cast<std::uint32_t>(bytes[26] << 24 | bytes[27] << 16 | bytes[28] << 8 | bytes[29]);
    const std::size_t packet = static_cast<std::size_t>(bytes[16]) << 8 | bytes[17];
    const std::size_t header = frame.protocol == 17 ? 8 : static_cast<std::size_t>(bytes[46] >> 4) * 4;
    frame.payload = bytes.subspan(34 + header, packet - 20 - header);
    frames.push_back(frame);
    at += 16 + length;
  }
  return frames;
}

TEST_F(RecordedCaptureTest, HoldsEveryTelegramAsItWasSentWithItsReceiptTime) {
  for (const auto language : {ColaLanguage::A, ColaLanguage::B}) {
    settings_.telegrams.language = language;
    const fs::path path = folder_ / (language == ColaLanguage::A ? "a.pcap" : "b.pcap");
    const auto events = record(path);
    const Bytes file = read(path);
    std::map<std::uint32_t, ColaFramer> lasers;
    PlateFramer plate;
    std::vector<HubEvent> found;
    std::int64_t last = 0;
    for (const auto& frame : parse(file)) {
      ASSERT_GE(frame.time_ns, last);
      last = frame.time_ns;
      if (frame.protocol == 17) {
        plate.feed(frame.payload, frame.time_ns,
                   [&](const PlateReading& reading) { found.emplace_back(reading); });
        continue;
      }
      lasers[frame.from].feed(frame.payload, frame.time_ns, [&](const ColaFrame& telegram) {
        const auto parsed = parse_cola(telegram.payload, telegram.language);
        ASSERT_TRUE(parsed);
        if (parsed->command != "sSN") return;
        LaserTelegram received{.laser = static_cast<std::uint16_t>((frame.from & 0xff) - 1),
                               .receipt_ns = telegram.completed_ns};
        ASSERT_EQ(decode_scan_data(*parsed, EncoderWidths::Position32, received.data), FieldFailure::None);
        found.emplace_back(received);
      });
    }
    ASSERT_EQ(found.size(), events.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(found[i].index(), events[i].index());
      ASSERT_EQ(receipt_ns(found[i]), receipt_ns(events[i]));
      if (const auto* telegram = std::get_if<LaserTelegram>(&events[i])) {
        ASSERT_EQ(std::get<LaserTelegram>(found[i]).laser, telegram->laser);
        ASSERT_EQ(std::get<LaserTelegram>(found[i]).data, telegram->data);
      } else {
        const auto& reading = std::get<PlateReading>(events[i]);
        ASSERT_EQ(std::get<PlateReading>(found[i]).count, reading.count);
        ASSERT_EQ(std::get<PlateReading>(found[i]).device_us, reading.device_us);
        ASSERT_EQ(std::get<PlateReading>(found[i]).sequence, reading.sequence);
      }
    }
  }
}

TEST_F(RecordedCaptureTest, IsMarkedAsSimulatedInEveryFrame) {
  record(folder_ / "hub.pcap");
  CaptureFile capture(folder_ / "hub.pcap");
  std::size_t frames = 0;
  for (; const Packet* packet = capture.next(); ++frames) {
    ASSERT_EQ(origin_of(packet->bytes), FrameOrigin::Simulated);
  }
  EXPECT_GT(frames, 0U);
}

TEST_F(RecordedCaptureTest, HasTheSameBytesForTheSameSeed) {
  record(folder_ / "a.pcap", {.lost = 0.01, .repeated = 0.01, .damaged = 0.01});
  record(folder_ / "b.pcap", {.lost = 0.01, .repeated = 0.01, .damaged = 0.01});
  const Bytes a = read(folder_ / "a.pcap");
  EXPECT_GT(a.size(), 50'000U);
  EXPECT_TRUE(a == read(folder_ / "b.pcap"));
  settings_.scanner.seed = 2;
  record(folder_ / "c.pcap");
  EXPECT_FALSE(a == read(folder_ / "c.pcap"));
}

TEST_F(RecordedCaptureTest, LosesRepeatsAndDamagesFramesAsOftenAsRequested) {
  record(folder_ / "clean.pcap");
  const double clean = static_cast<double>(parse(read(folder_ / "clean.pcap")).size());
  record(folder_ / "faulty.pcap", {.lost = 0.1, .repeated = 0.05, .damaged = 0.02});
  EXPECT_NEAR(static_cast<double>(counts_.lost), 0.1 * clean, 4 * std::sqrt(0.1 * clean));
  EXPECT_NEAR(static_cast<double>(counts_.repeated), 0.045 * clean, 4 * std::sqrt(0.05 * clean));
  EXPECT_NEAR(static_cast<double>(counts_.damaged), 0.018 * clean, 4 * std::sqrt(0.02 * clean));
  EXPECT_EQ(static_cast<double>(parse(read(folder_ / "faulty.pcap")).size()),
            clean - static_cast<double>(counts_.lost) + static_cast<double>(counts_.repeated));
}

TEST_F(RecordedCaptureTest, LeavesNothingBehindWhenItIsNotClosed) {
  const Scene scene = office();
  {
    RecordingSimulator simulator(settings_, scene);
    RecordedCapture capture(folder_ / "hub.pcap", settings_, simulator.truth());
    capture.write(*simulator.next());
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(RecordedCaptureTest, RefusesWhatCannotBeWritten) {
  const auto truth = draw_devices(settings_);
  EXPECT_THROW(RecordedCapture("/dev/null/x.pcap", settings_, truth), Error) << "no folder";
  EXPECT_THROW(RecordedCapture(folder_ / "x.pcap", settings_, truth, {.lost = 2}), Error);
  settings_.scanner.rig.lasers[0].address.ip = "192.168.0.100";
  EXPECT_THROW(RecordedCapture(folder_ / "x.pcap", settings_, truth), Error) << "the hub's own address";
}

TEST_F(RecordedCaptureTest, ItsTruthReadsBackAsTheCalibrationThatItIs) {
  settings_.scanner.truth.lasers[1].tau.value = 0.2123456789012345;
  settings_.scanner.truth.lasers[1].eta.value = -0.0123;
  const auto truth = draw_devices(settings_);
  write_truth(folder_ / "truth.yaml", truth, settings_, "office");
  const Calibration back = read_calibration(folder_ / "truth.yaml");
  EXPECT_EQ(back.lasers[1].tau.value, 0.2123456789012345);
  EXPECT_EQ(back.lasers[1].eta.value, -0.0123);
  EXPECT_EQ(back.provenance.at("scene"), "office");
  EXPECT_EQ(std::stod(back.provenance.at("laser3.clock.skew")), truth.lasers[2].clock.skew);
  EXPECT_EQ(std::stod(back.provenance.at("plate.minimum_delay")), truth.plate.minimum_delay);
}

}  // namespace
}  // namespace crisp
