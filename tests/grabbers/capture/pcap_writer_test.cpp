// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/pcap_writer.hpp"

#include <gmock/gmock.h>
#include <pcap/pcap.h>
#include <sys/resource.h>

#include <csignal>

#include <crisp/error.hpp>

#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;
using testing::ElementsAre;
using testing::Pair;

constexpr std::int64_t kTime = 1'700'000'000'123'456'789;

/// What libpcap finds: time and first byte of each record.
std::vector<std::pair<std::int64_t, int>> records(const std::filesystem::path& path) {
  char message[PCAP_ERRBUF_SIZE] = "";
  auto* pcap = pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, message);
  EXPECT_NE(pcap, nullptr) << message;
  std::vector<std::pair<std::int64_t, int>> found;
  pcap_pkthdr* header = nullptr;
  const u_char* data = nullptr;
  int result = 0;
  while ((result = pcap_next_ex(pcap, &header, &data)) == 1) {
    found.emplace_back(header->ts.tv_sec * 1'000'000'000LL + header->ts.tv_usec, data[0]);
  }
  EXPECT_EQ(result, PCAP_ERROR_BREAK) << pcap_geterr(pcap);
  pcap_close(pcap);
  return found;
}

TEST(PcapWriter, WritesWhatLibpcapReadsToTheNanosecond) {
  const TemporaryFolder folder;
  PcapWriter writer(folder / "a.pcap", PcapMode::Replace);
  writer.write(kTime, Bytes(60, 1));
  writer.write(kTime + 1, Bytes(1514, 2));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pcap")) << "not before it is whole";
  writer.close();
  EXPECT_THAT(records(folder / "a.pcap"), ElementsAre(Pair(kTime, 1), Pair(kTime + 1, 2)));
  EXPECT_EQ(writer.bytes(), std::filesystem::file_size(folder / "a.pcap"));
}

TEST(PcapWriter, LeavesTheOldFileWhenAReplacingOneIsGivenUp) {
  const TemporaryFolder folder;
  write_file(folder / "a.pcap", Bytes(3, 9));
  { PcapWriter(folder / "a.pcap", PcapMode::Replace).write(kTime, Bytes(60, 1)); }
  EXPECT_EQ(read_file(folder / "a.pcap"), Bytes(3, 9));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "."), {}), 1)
      << "nothing else is left";
}

TEST(PcapWriter, GoesOnBehindARecordThatACrashLeftHalfWritten) {
  const TemporaryFolder folder;
  {
    PcapWriter writer(folder / "a.pcap", PcapMode::Grow);
    writer.write(kTime, Bytes(60, 1));
    writer.write(kTime + 5, Bytes(60, 2));
    writer.close();
  }
  const auto whole = read_file(folder / "a.pcap");
  for (std::size_t cut = 24; cut <= whole.size(); cut += 4) {
    write_file(folder / "b.pcap", ByteView(whole).first(cut));
    PcapWriter writer(folder / "b.pcap", PcapMode::Grow);
    writer.write(kTime + 9, Bytes(60, 3));
    writer.close();
    const auto found = records(folder / "b.pcap");
    ASSERT_EQ(found.size(), 1 + (cut - 24) / 76) << "cut at " << cut;
    ASSERT_THAT(found.back(), Pair(kTime + 9, 3));
  }
}

TEST(PcapWriter, GivesWhatWasFlushedToOtherReadersAtOnce) {
  const TemporaryFolder folder;
  PcapWriter writer(folder / "a.pcap", PcapMode::Grow);
  writer.write(kTime, Bytes(60, 1));
  writer.flush();
  EXPECT_THAT(records(folder / "a.pcap"), ElementsAre(Pair(kTime, 1)));
}

TEST(PcapWriter, KeepsAnotherWriterOutOfAFileThatGrows) {
  const TemporaryFolder folder;
  PcapWriter writer(folder / "a.pcap", PcapMode::Grow);
  writer.write(kTime, Bytes(60, 1));
  try {
    const PcapWriter second(folder / "a.pcap", PcapMode::Grow);
    FAIL() << "two writers";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a.pcap is being written by another recorder"));
  }
  writer.close();
  PcapWriter(folder / "a.pcap", PcapMode::Grow).write(kTime + 1, Bytes(60, 2));
  EXPECT_THAT(records(folder / "a.pcap"), ElementsAre(Pair(kTime, 1), Pair(kTime + 1, 2)));
}

TEST(PcapWriter, RefusesToContinueAnotherKindOfFile) {
  const TemporaryFolder folder;
  const std::string text = "This is no capture but someone's precious notes.";
  write_file(folder / "notes.txt", as_bytes(text));
  EXPECT_THROW(PcapWriter(folder / "notes.txt", PcapMode::Grow), Error);
  EXPECT_EQ(as_text(read_file(folder / "notes.txt")), text);
}

TEST(PcapWriter, ReportsWhenAFolderIsMissing) {
  const TemporaryFolder folder;
  try {
    const PcapWriter writer(folder / "nowhere/a.pcap", PcapMode::Grow);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("No such file or directory"));
  }
}

TEST(PcapWriter, StopsWithAnErrorAndWholeRecordsWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  auto* old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = 100'000, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  PcapWriter writer(folder / "a.pcap", PcapMode::Grow);
  const auto fill = [&] {
    for (int i = 0; i < 1000; ++i) {
      writer.write(kTime + i, Bytes(1000, 7));
      if (i % 10 == 0) writer.flush();
    }
  };
  EXPECT_THROW(fill(), Error);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_GT(records(folder / "a.pcap").size(), 50U);
}

TEST(PcapWriter, RefusesTimesAndFramesThatAFileCannotHold) {
  const TemporaryFolder folder;
  PcapWriter writer(folder / "a.pcap", PcapMode::Replace);
  EXPECT_THROW(writer.write(-1, Bytes(60, 1)), Error);
  EXPECT_THROW(writer.write(kTime, Bytes(300'000, 1)), Error);
}

}  // namespace
}  // namespace crisp
