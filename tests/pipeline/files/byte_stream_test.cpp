// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/byte_stream.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <future>
#include <istream>
#include <iterator>
#include <memory>

#include <crisp/error.hpp>

#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::files;

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

class CompressedFile : public ByteStreamTest, public testing::WithParamInterface<const char*> {
 protected:
  CompressedFile() {
    for (std::uint64_t i = 0; i < 300'000; ++i) text_ += static_cast<char>(i * i % 251);
    test::put_bytes(file(), compressed(text_.substr(0, 100'000)) + compressed(text_.substr(100'000)));
  }
  std::filesystem::path file() const { return folder_ / "file"; }
  static std::string compressed(const std::string& text) {
    std::string out(2 * text.size() + 1000, '\0');
    if (std::string_view(GetParam()) == "zstd") {
      const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
      ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);  // as the program zstd does
      out.resize(ZSTD_compress2(context.get(), out.data(), out.size(), text.data(), text.size()));
      return out;
    }
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string in = text;
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
  }
  std::string text_;
};
INSTANTIATE_TEST_SUITE_P(ByEach, CompressedFile, testing::Values("gzip", "zstd"));

TEST_P(CompressedFile, IsReadAsWhatItWas) {
  ByteStream stream(file());
  EXPECT_EQ(read_to_end(stream), text_);
  EXPECT_EQ(stream.size(), 0U) << "nobody knows";
}

TEST_P(CompressedFile, IsReadFromAnyPlace) {
  ByteStream stream(file());
  for (const std::size_t place : {150'000U, 20'000U, 299'999U, 0U}) {
    stream.move_to(place);
    EXPECT_EQ(read_to_end(stream), text_.substr(place)) << place;
  }
}

TEST_P(CompressedFile, ThatEndsEarlyOrIsDamagedIsAnErrorThatNamesIt) {
  const std::string bytes = test::bytes_of(file());
  std::string damaged = bytes;
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i)
    damaged[i] = static_cast<char>(~damaged[i]);
  for (const std::string& wrong : {bytes.substr(0, bytes.size() - 5), damaged}) {
    test::put_bytes(file(), wrong);
    ByteStream stream(file());
    try {
      read_to_end(stream);
      FAIL() << "read it";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(file().string() + " cannot be decompressed from byte"));
    }
  }
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

TEST_F(ByteStreamTest, GivesUpAPipeWithASilentWriter) {
  std::atomic<bool> stop = false;
  ByteStream stream(pipe(), [&] { return stop.load(); });
  const int writer = open(pipe().c_str(), O_WRONLY);
  auto text = std::async(std::launch::async, [&] { return read_to_end(stream); });
  stop = true;
  EXPECT_THROW(text.get(), Interrupted);
  close(writer);
}

TEST_F(ByteStreamTest, GivesUpAStreamWithoutEnd) {
  int requested = 0;
  ByteStream stream("/dev/zero", [&] { return ++requested > 10; });
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
