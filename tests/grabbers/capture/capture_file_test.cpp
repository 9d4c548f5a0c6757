// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/capture_file.hpp"

#include <gmock/gmock.h>
#include <pcap/pcap.h>
#include <zlib.h>

#include <crisp/error.hpp>

#include "tests/grabbers/capture/capture_bytes.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"
#include "tests/support/shared_data.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;
using testing::ElementsAre;
using testing::SizeIs;

class CaptureFileTest : public testing::Test {
 protected:
  std::vector<Frame> read(ByteView file) {
    const MemoryFile in_memory(file);
    return read(in_memory.path());
  }

  std::vector<Frame> read(const std::filesystem::path& path) {
    CaptureFile capture(path);
    std::vector<Frame> found;
    while (const auto* packet = capture.next()) {
      found.push_back({packet->time_ns, Bytes(packet->bytes.begin(), packet->bytes.end()), packet->link_type,
                       packet->original_size});
    }
    losses_ = capture.losses();
    notes_ = capture.notes();
    return found;
  }

  TemporaryFolder folder_;
  Counts losses_;
  Counts notes_;
};

bool same(const Frame& a, const Frame& b) { return a.time_ns == b.time_ns && a.bytes == b.bytes; }

/// Packets of sizes and contents that differ, a millisecond apart.
std::vector<Frame> packets(std::size_t n) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < n; ++i) {
    Bytes bytes(60 + 7 * i % 50);
    for (std::size_t j = 0; j < bytes.size(); ++j) bytes[j] = static_cast<std::uint8_t>(200 + 31 * i + j);
    frames.push_back({kStart + static_cast<std::int64_t>(i) * 1'000'123, bytes});
  }
  return frames;
}

TEST_F(CaptureFileTest, ReadsBothByteOrdersAndPrecisions) {
  const auto written = packets(5);
  for (const auto order : {ByteOrder::Little, ByteOrder::Big}) {
    for (const bool nanoseconds : {false, true}) {
      const auto found = read(pcap_file(written, {order, nanoseconds, 113}));
      ASSERT_THAT(found, SizeIs(5));
      for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(found[i].bytes, written[i].bytes);
        EXPECT_EQ(found[i].time_ns, nanoseconds ? written[i].time_ns : written[i].time_ns / 1000 * 1000);
        EXPECT_EQ(found[i].interface, 113U);
      }
      EXPECT_TRUE(losses_.all().empty());
    }
  }
}

/// The upper bits of the link type announce a frame checksum of 4 bytes (2 times 16 bits).
TEST_F(CaptureFileTest, DistinguishesTheLinkTypeFromTheLengthOfAChecksum) {
  const auto found = read(pcap_file(packets(2), {ByteOrder::Little, false, 0x24000001}));
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].interface, 1U);
}

TEST_F(CaptureFileTest, ReadsACaptureThatGzipCompressed) {
  const auto written = packets(50);
  const auto bytes = pcap_file(written);
  gzFile file = gzopen((folder_ / "hub.pcap.gz").c_str(), "wb");
  ASSERT_EQ(gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size())), static_cast<int>(bytes.size()));
  ASSERT_EQ(gzclose(file), Z_OK);
  const auto found = read(folder_ / "hub.pcap.gz");
  ASSERT_THAT(found, SizeIs(50));
  EXPECT_EQ(found[49].bytes, written[49].bytes);
  EXPECT_TRUE(losses_.all().empty());
}

TEST_F(CaptureFileTest, FindsInRealCapturesWhatLibpcapFinds) {
  for (const auto* name : {"sick/lms111-20210302-colab-rebuilt.pcap", "sick/tim781s-20210106-colab.pcapng"}) {
    const auto path = shared_data() / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data: " << name;
    const auto found = read(path);
    EXPECT_TRUE(losses_.all().empty());
    char message[PCAP_ERRBUF_SIZE] = "";
    auto* pcap = pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, message);
    ASSERT_NE(pcap, nullptr) << message;
    pcap_pkthdr* header = nullptr;
    const u_char* data = nullptr;
    std::size_t n = 0;
    for (; pcap_next_ex(pcap, &header, &data) == 1; ++n) {
      ASSERT_LT(n, found.size());
      ASSERT_EQ(found[n].time_ns, header->ts.tv_sec * 1'000'000'000LL + header->ts.tv_usec);
      ASSERT_EQ(found[n].bytes, Bytes(data, data + header->caplen));
      ASSERT_EQ(found[n].original_size, header->len);
    }
    pcap_close(pcap);
    EXPECT_EQ(n, found.size());
  }
}

TEST_F(CaptureFileTest, ReadsPcapngOfSeveralInterfacesAndSections) {
  const auto p = packets(6);
  const auto ns = static_cast<std::uint64_t>(p[0].time_ns);
  auto with_interface = [&](std::size_t i, std::uint32_t interface) {
    return Frame{p[i].time_ns, p[i].bytes, interface};
  };
  PcapngBuilder little(ByteOrder::Little), big(ByteOrder::Big);
  little.section().interface(1, 9).interface(113, 6).interface(276, 0x80 | 30);
  little.packet(with_interface(0, 0), ns);
  little.block(0x0BAD, Bytes(10, 1));  // a block of a kind that nobody knows
  little.packet(with_interface(1, 1), static_cast<std::uint64_t>(p[1].time_ns / 1000));
  little.packet(with_interface(2, 2),
                (std::uint64_t{1'700'000'000} << 30) + (1 << 28));  // a quarter of a second
  little.simple_packet(p[0].bytes);
  big.section().interface(101, 3, 1'699'900'000);
  big.obsolete_packet(with_interface(3, 0), 100'000'500);  // ms since the offset
  auto file = little.bytes();
  file.insert(file.end(), big.bytes().begin(), big.bytes().end());
  const auto found = read(file);
  ASSERT_THAT(found, SizeIs(4));
  EXPECT_EQ(found[0].time_ns, p[0].time_ns);
  EXPECT_EQ(found[1].time_ns, p[1].time_ns / 1000 * 1000);
  EXPECT_EQ(found[2].time_ns, 1'700'000'000'250'000'000);
  EXPECT_EQ(found[3].time_ns, 1'700'000'000'500'000'000) << "milliseconds since the interface's offset";
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(found[i].bytes, p[i].bytes);
  EXPECT_EQ(found[0].interface, 1U);
  EXPECT_EQ(found[1].interface, 113U);
  EXPECT_EQ(found[2].interface, 276U);
  EXPECT_EQ(found[3].interface, 101U);
  EXPECT_EQ(losses_.of(file_loss::kNoStamp), 1U);
}

TEST_F(CaptureFileTest, ReportsWhatTheCapturingComputerDropped) {
  PcapngBuilder file(ByteOrder::Little);
  file.section().interface(1, 9).statistics(0, 3).statistics(0, 10).statistics(7, 99);
  read(file.bytes());
  EXPECT_EQ(losses_.of(file_loss::kNotCaptured), 10U) << "totals, the last of which counts";
}

TEST_F(CaptureFileTest, CountsPacketsOfAnInterfaceThatWasNeverDescribed) {
  PcapngBuilder file(ByteOrder::Big);
  file.section().interface(1, 9).packet({0, Bytes(60), 4}, 1);
  EXPECT_THAT(read(file.bytes()), SizeIs(0));
  EXPECT_EQ(losses_.of(file_loss::kUnknownInterface), 1U);
}

/// The same packets in both formats.
std::vector<Bytes> both_formats(const std::vector<Frame>& frames) {
  PcapngBuilder builder(ByteOrder::Little);
  builder.section().interface(1, 9);
  for (const auto& frame : frames) builder.packet(frame, static_cast<std::uint64_t>(frame.time_ns));
  return {pcap_file(frames), pcap_file(frames, {.order = ByteOrder::Big}), builder.bytes()};
}

TEST_F(CaptureFileTest, GivesEveryWholePacketOfAFileCutAnywhere) {
  const auto written = packets(6);
  for (const auto& file : both_formats(written)) {
    std::size_t before = 0;
    for (std::size_t cut = 24; cut <= file.size(); ++cut) {
      const auto found = read(ByteView(file).first(cut));
      ASSERT_GE(found.size(), before) << cut;
      ASSERT_LE(found.size(), written.size());
      for (std::size_t i = 0; i < found.size(); ++i) ASSERT_TRUE(same(found[i], written[i]));
      before = found.size();
    }
    EXPECT_EQ(before, written.size());
    EXPECT_TRUE(losses_.all().empty());
    read(ByteView(file).first(file.size() - 1));
    EXPECT_GT(losses_.of(file_loss::kCutOff), 0U);
  }
}

TEST_F(CaptureFileTest, LosesAtMostTheRecordInWhichABitFlips) {
  const auto written = packets(12);
  for (const auto& file : both_formats(written)) {
    const std::size_t first = file.size() / 3;  // far from the file's own header
    for (std::size_t bit = first * 8; bit < file.size() * 2 / 3 * 8; ++bit) {
      auto damaged = file;
      damaged[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
      const auto found = read(damaged);
      std::size_t whole = 0;
      std::size_t right = 0;
      for (const auto& frame : written) {
        const auto same_bytes = [&](const auto& f) { return f.bytes == frame.bytes; };
        whole += std::any_of(found.begin(), found.end(), same_bytes) ? 1 : 0;
        right +=
            std::any_of(found.begin(), found.end(), [&](const auto& f) { return same(f, frame); }) ? 1 : 0;
      }
      ASSERT_GE(whole, written.size() - 1) << "bit " << bit;
      // One packet that comes a little late takes the next one along: which of the two is wrong is not known.
      ASSERT_GE(right, written.size() - 2) << "bit " << bit;
      ASSERT_LE(found.size(), written.size());
      const bool as_names =
          damaged[bit / 8] == 4 && file[bit / 8] == 6;  // a kind of block that is passed over
      ASSERT_TRUE(found.size() == written.size() || !losses_.all().empty() || as_names) << "bit " << bit;
    }
  }
}

TEST_F(CaptureFileTest, DropsAPacketWhoseTimeIsFarFromItsNeighbours) {
  for (const std::int64_t shift :
       {-1'000'000'000'000'000'000, -5'000'000'000, 5'000'000'000, 1'000'000'000'000'000'000}) {
    auto written = packets(5);
    written[2].time_ns += shift;
    EXPECT_THAT(read(pcap_file(written)), SizeIs(4));
    EXPECT_EQ(losses_.of(file_loss::kDamagedStamps) + losses_.of(file_loss::kDamagedRecords), 1U);
  }
}

TEST_F(CaptureFileTest, APacketComesNoEarlierThanTheOneBeforeIt) {
  auto written = packets(5);
  const auto right = written[1].time_ns;
  written[2].time_ns = right - 400'000'000;
  EXPECT_EQ(read(pcap_file(written)).at(2).time_ns, right);
  EXPECT_EQ(notes_.of(file_loss::kBeforeItsTime), 1U);
  EXPECT_TRUE(losses_.all().empty());

  written[2].time_ns = right + 900'000'000;  // one that is late makes none of the others late
  const auto late = read(pcap_file(written));
  for (const std::size_t i : {0, 1, 3, 4}) EXPECT_EQ(late.at(i).time_ns, written[i].time_ns);
}

TEST_F(CaptureFileTest, KeepsPacketsAcrossPausesAndSteppedClocks) {
  auto paused = packets(6);
  for (std::size_t i = 3; i < 6; ++i) paused[i].time_ns += 5 * 3'600'000'000'000;
  EXPECT_THAT(read(pcap_file(paused)), SizeIs(6));
  auto stepped = packets(6);
  for (std::size_t i = 3; i < 6; ++i) stepped[i].time_ns -= 30'000'000'000;
  EXPECT_THAT(read(pcap_file(stepped)), SizeIs(6));
}

TEST_F(CaptureFileTest, PassesOverTheZerosThatAPowerCutLeaves) {
  auto file = pcap_file(packets(3));
  file.resize(file.size() + 5000);
  EXPECT_THAT(read(file), SizeIs(3));
  EXPECT_EQ(losses_.of(file_loss::kSkippedBytes), 5000U);
}

TEST_F(CaptureFileTest, FindsItsWayAfterMegabytesOfGarbage) {
  auto file = pcap_file(packets(3));
  const auto more = pcap_file(packets(9));
  file.resize(file.size() + 3'000'000, 0xEE);
  file.insert(file.end(), more.begin() + 24, more.end());
  const auto found = read(file);
  ASSERT_THAT(found, SizeIs(12));
  EXPECT_EQ(losses_.of(file_loss::kDamagedRecords), 1U);
  EXPECT_EQ(losses_.of(file_loss::kSkippedBytes), 3'000'000U);
}

TEST_F(CaptureFileTest, RefusesWhatIsNoCapture) {
  EXPECT_THROW(read(Bytes()), Error);
  EXPECT_THROW(read(as_bytes("Hello, I am a text.")), Error);
  EXPECT_THROW(read(ByteView(pcap_file({})).first(20)), Error);
  EXPECT_THROW(read(folder_ / "missing.pcap"), Error);
  EXPECT_THROW(read(folder_ / "."), Error);
}

}  // namespace
}  // namespace crisp
