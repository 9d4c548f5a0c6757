// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/byte_stream.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <future>
#include <istream>
#include <iterator>

#include "pipeline/data/error.hpp"
#include "pipeline/data/interrupted.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

std::string read_to_end(ByteStream& stream) {
  ByteStreamBuffer buffer(stream);
  std::istream in(&buffer);
  in.exceptions(std::ios::badbit);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ByteStreamTest : public testing::Test {
 protected:
  std::filesystem::path pipe() const {
    mkfifo((folder_ / "pipe").c_str(), 0600);
    return folder_ / "pipe";
  }
  test::TemporaryFolder folder_;
};

TEST_F(ByteStreamTest, GivesWhatIsInAFile) {
  const std::string text(200'000, 'x');
  test::put_bytes(folder_ / "file", text + "y");
  ByteStream stream(folder_ / "file");
  EXPECT_EQ(stream.size(), 200'001U);
  EXPECT_EQ(read_to_end(stream), text + "y");
}

TEST_F(ByteStreamTest, NamesAFileThatCannotBeRead) {
  for (const auto& path : {folder_ / "none", folder_.path()}) {
    try {
      const ByteStream stream(path);
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("cannot read " + path.string()));
    }
  }
}

TEST_F(ByteStreamTest, WaitsForThoseWhoWriteIntoAPipe) {
  ByteStream stream(pipe());
  auto text = std::async(std::launch::async, [&] { return read_to_end(stream); });
  const int writer = open(pipe().c_str(), O_WRONLY);
  ASSERT_EQ(write(writer, "one ", 4), 4);
  ASSERT_EQ(write(writer, "two", 3), 3);
  close(writer);
  EXPECT_EQ(text.get(), "one two");
}

TEST_F(ByteStreamTest, GivesUpAPipeIntoWhichNobodyWrites) {
  std::atomic<bool> stop = false;
  ByteStream stream(pipe(), [&] { return stop.load(); });
  auto text = std::async(std::launch::async, [&] { return read_to_end(stream); });
  stop = true;
  EXPECT_THROW(text.get(), Interrupted);
}

TEST_F(ByteStreamTest, GivesUpAPipeWhoseWriterSaysNothing) {
  std::atomic<bool> stop = false;
  ByteStream stream(pipe(), [&] { return stop.load(); });
  const int writer = open(pipe().c_str(), O_WRONLY);
  auto text = std::async(std::launch::async, [&] { return read_to_end(stream); });
  stop = true;
  EXPECT_THROW(text.get(), Interrupted);
  close(writer);
}

TEST_F(ByteStreamTest, GivesUpAStreamWithoutEnd) {
  int asked = 0;
  ByteStream stream("/dev/zero", [&] { return ++asked > 10; });
  std::array<char, 4096> block{};
  EXPECT_THROW(
      {
        while (stream.read(block.data(), block.size()) > 0) {
        }
      },
      Interrupted);
}

}  // namespace
}  // namespace crisp
