// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_file.hpp"

#include <gmock/gmock.h>
#include <zstd.h>

#include <crisp/error.hpp>

#include "tests/grabbers/bag/bag_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

struct Format {
  std::string ending, compression;
};

void PrintTo(const Format& format, std::ostream* out) { *out << format.ending << " " << format.compression; }

void write_bag(const fs::path& file, const test::TestBag& bag, const std::string& compression) {
  if (file.extension() == ".bag") test::write_rosbag1(file, bag, compression);
  if (file.extension() == ".mcap") test::write_mcap(file, bag, compression);
  if (file.extension() == ".db3") test::write_db3(file, bag);
}

test::TestBag sample_bag() {
  test::TestBag bag{.topics = {{"/scan", "sensor_msgs/msg/LaserScan", "float32 a\n"},
                               {"/count", "std_msgs/msg/Int32", "int32 data\n"}}};
  for (int i = 0; i < 500; ++i) {
    bag.messages.push_back({static_cast<std::size_t>(i % 2), 1'700'000'000'123'456'789 + i,
                            std::string(static_cast<std::size_t>(i), static_cast<char>('a' + i % 7))});
  }
  return bag;
}

class BagFileTest : public testing::TestWithParam<Format> {
 protected:
  fs::path file() const { return folder_ / ("bag" + GetParam().ending); }
  void write(const test::TestBag& bag) const { write_bag(file(), bag, GetParam().compression); }

  test::TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(OfEachFormat, BagFileTest,
                         testing::Values(Format{".bag", ""}, Format{".bag", "none"}, Format{".bag", "bz2"},
                                         Format{".bag", "lz4"}, Format{".mcap", "unchunked"},
                                         Format{".mcap", ""}, Format{".mcap", "lz4"}, Format{".mcap", "zstd"},
                                         Format{".db3", ""}));

TEST_P(BagFileTest, GivesEveryMessageAsItWasRecorded) {
  const auto bag = sample_bag();
  write(bag);
  BagFile read(file());
  for (const auto& expected : bag.messages) {
    const auto message = read.reader().next();
    ASSERT_TRUE(message);
    const BagConnection& connection = read.reader().connections()[message->connection];
    ASSERT_EQ(connection.topic, bag.topics[expected.topic].name);
    ASSERT_EQ(message->receipt_ns, expected.receipt_ns);
    ASSERT_EQ(message->data, expected.bytes);
  }
  EXPECT_FALSE(read.reader().next());
  EXPECT_THAT(read.reader().losses(), IsEmpty());
  ASSERT_EQ(read.reader().connections().size(), 2U);
}

TEST_P(BagFileTest, GivesNothingOfABagWithoutMessages) {
  write({.topics = sample_bag().topics});
  BagFile read(file());
  EXPECT_FALSE(read.reader().next());
  EXPECT_THAT(read.reader().losses(), IsEmpty());
}

/// Whatever bytes are there, the reader comes to an end; a length that is damaged costs no memory.
TEST_P(BagFileTest, ComesToAnEndWhereverTheFileIsCutOff) {
  write(sample_bag());
  const std::string bytes = test::bytes_of(file());
  for (std::size_t size = 20; size < bytes.size(); size += 1 + bytes.size() / 41) {
    test::put_bytes(file(), bytes.substr(0, size));
    std::size_t messages = 0;
    try {
      BagFile read(file());
      while (read.reader().next()) ++messages;
    } catch (const Error&) {  // SQLite's file is no database any more
      EXPECT_EQ(GetParam().ending, ".db3");
    }
    EXPECT_LE(messages, 500U);
  }
}

TEST_P(BagFileTest, ComesToAnEndWhereverAByteIsDamaged) {
  write(sample_bag());
  const std::string bytes = test::bytes_of(file());
  for (std::size_t at = 20; at < bytes.size(); at += 1 + bytes.size() / 67) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(~damaged[at]);
    test::put_bytes(file(), damaged);
    try {
      BagFile read(file());
      while (read.reader().next()) continue;
    } catch (const Error&) {
      EXPECT_EQ(GetParam().ending, ".db3");
    }
  }
}

class BagFiles : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(BagFiles, ACutOffBagIsReadAsFarAsItGoesAndTheLossCounted) {
  test::write_rosbag1(folder_ / "a.bag", sample_bag(), "");
  const std::string bytes = test::bytes_of(folder_ / "a.bag");
  test::put_bytes(folder_ / "a.bag", bytes.substr(0, bytes.size() / 2));
  BagFile read(folder_ / "a.bag");
  std::size_t messages = 0;
  while (read.reader().next()) ++messages;
  EXPECT_GT(messages, 100U);
  EXPECT_EQ(read.reader().losses().at("bags that end within a record"), 1U);
}

TEST_F(BagFiles, AChunkThatIsDamagedIsCounted) {
  test::write_mcap(folder_ / "a.mcap", sample_bag(), "");
  std::string bytes = test::bytes_of(folder_ / "a.mcap");
  bytes[bytes.size() / 2] ^= 1;
  test::put_bytes(folder_ / "a.mcap", bytes);
  BagFile read(folder_ / "a.mcap");
  EXPECT_FALSE(read.reader().next());
  EXPECT_EQ(read.reader().losses().at("chunks with a wrong checksum"), 1U);
}

TEST_F(BagFiles, ReadsABagThatZstdCompressedAndRefusesADatabase) {
  const auto compress = [&](const char* from, const char* to) {
    const std::string bytes = test::bytes_of(folder_ / from);
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
    test::put_bytes(folder_ / to, out);
  };
  test::write_rosbag1(folder_ / "a.bag", sample_bag(), "none");
  test::write_db3(folder_ / "a.db3", sample_bag());
  compress("a.bag", "a.bag.zst");
  compress("a.db3", "a.db3.zstd");
  BagFile read(folder_ / "a.bag.zst");
  std::size_t messages = 0;
  while (read.reader().next()) ++messages;
  EXPECT_EQ(messages, 500U);
  EXPECT_THROW(BagFile(folder_ / "a.db3.zstd"), Error);
}

TEST_F(BagFiles, RefusesWhatIsNoBag) {
  test::put_bytes(folder_ / "a.bag", "#ROSBAG V1.2\n");
  EXPECT_THROW(BagFile(folder_ / "a.bag"), Error);
  EXPECT_THROW(BagFile(folder_ / "none.bag"), Error);
  fs::create_directory(folder_ / "empty");
  EXPECT_THROW(files_of_bag(folder_ / "empty"), Error);
}

TEST_F(BagFiles, AFolderStandsForTheBagsInIt) {
  for (const auto* name : {"run_1.mcap", "run_0.mcap", "metadata.yaml"}) test::put_bytes(folder_ / name, "");
  EXPECT_THAT(files_of_bag(folder_.path()),
              testing::ElementsAre(folder_ / "run_0.mcap", folder_ / "run_1.mcap"));
}

}  // namespace
}  // namespace crisp
