// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/tcp_stream.hpp"

#include <gmock/gmock.h>

#include <numeric>
#include <random>

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::devices;
using namespace crisp::wire;
using testing::ElementsAre;

constexpr std::int64_t kWait = 1000;

/// What came out: bytes with their times, '|' for a gap.
class Recorder : public StreamSink {
 public:
  void data(ByteView bytes, std::int64_t arrival_ns) override {
    text += as_text(bytes);
    times.insert(times.end(), bytes.size(), arrival_ns);
  }
  void gap() override { text += '|'; }
  void repeated(ByteView bytes) override { again += as_text(bytes); }
  std::string text, again;
  std::vector<std::int64_t> times;
};

class TcpStreamTest : public testing::Test {
 protected:
  void send(std::uint32_t sequence, std::string_view text, std::int64_t time, std::uint32_t missing = 0) {
    TransportPacket segment{.sequence = sequence, .payload = as_bytes(text), .missing = missing};
    stream_.take(segment, time);
  }
  void end(std::uint32_t sequence, std::int64_t time) {
    stream_.take({.sequence = sequence, .fin = true}, time);
  }
  void flag(std::uint32_t sequence, bool syn, bool reset, std::int64_t time) {
    stream_.take({.sequence = sequence, .syn = syn, .reset = reset}, time);
  }

  Recorder out_;
  TcpStream stream_{out_, kWait};
};

TEST_F(TcpStreamTest, PutsSegmentsInOrderAndKeepsTheirTimes) {
  flag(99, true, false, 0);
  send(100, "ab", 1);
  send(104, "ef", 2);
  send(102, "cd", 3);
  send(106, "gh", 4);
  EXPECT_EQ(out_.text, "abcdefgh");
  EXPECT_THAT(out_.times, ElementsAre(1, 1, 3, 3, 2, 2, 4, 4));
  EXPECT_EQ(stream_.counts().late_segments, 1U);
}

TEST_F(TcpStreamTest, SegmentsAfterAHoleThatStaysAreNotOutOfOrder) {
  flag(99, true, false, 0);
  send(100, "ab", 1);
  send(104, "ef", 2);
  send(106, "gh", 3);
  stream_.finish();
  EXPECT_EQ(out_.text, "ab|efgh");
  EXPECT_EQ(stream_.counts().late_segments, 0U);
}

TEST_F(TcpStreamTest, BeginsInMidConnection) {
  send(77'000, "ab", 1);
  send(77'002, "cd", 2);
  EXPECT_EQ(out_.text, "abcd");
}

TEST_F(TcpStreamTest, GivesRepeatedBytesOnceAtTheirFirstTime) {
  send(100, "abcd", 1);
  send(100, "abcd", 5);
  send(102, "cdef", 6);
  send(101, "bcdefgh", 7);
  EXPECT_EQ(out_.text, "abcdefgh");
  EXPECT_THAT(out_.times, ElementsAre(1, 1, 1, 1, 6, 6, 7, 7));
  EXPECT_EQ(out_.again, "abcd");
  EXPECT_EQ(stream_.counts().repeated_segments, 1U);
}

TEST_F(TcpStreamTest, PassesTheWrapOfSequenceNumbers) {
  send(0xFFFFFFFD, "abc", 1);
  send(2, "fg", 2);
  send(0, "de", 3);
  EXPECT_EQ(out_.text, "abcdefg");
}

TEST_F(TcpStreamTest, WaitsForAHoleButNotForever) {
  send(100, "ab", 0);
  send(106, "gh", 10);
  EXPECT_EQ(stream_.waiting_since(), 10);
  stream_.expire(10 + kWait);
  EXPECT_EQ(out_.text, "ab");
  stream_.expire(11 + kWait);
  EXPECT_EQ(out_.text, "ab|gh");
  EXPECT_FALSE(stream_.waiting_since());
  EXPECT_EQ(stream_.counts().lost_bytes, 4U);
  EXPECT_EQ(stream_.counts().holes, 1U);
  send(102, "cdef", 12 + kWait);
  EXPECT_EQ(out_.text, "ab|gh") << "too late";
}

TEST_F(TcpStreamTest, DoesNotWaitWithMoreThanFourMegabytes) {
  send(0, "a", 0);
  const std::string big(10'000, 'x');
  for (std::uint32_t i = 0; i < 100; ++i) send(2 + 10'000 * i, big, 1);  // 1 MB: the farthest plausible one
  EXPECT_EQ(out_.text, "a");
  for (std::uint32_t i = 0; i < 5000; ++i) send(2 + i * 3 + 3, "yy", 1);
  EXPECT_LE(out_.text.size(), 1'100'000U);
}

TEST_F(TcpStreamTest, GivesWhatWaitsWhenTheCaptureEnds) {
  send(100, "ab", 0);
  send(104, "ef", 1);
  send(108, "ij", 2);
  stream_.finish();
  EXPECT_EQ(out_.text, "ab|ef|ij");
  EXPECT_EQ(stream_.counts().lost_bytes, 4U);
}

TEST_F(TcpStreamTest, BeginsAnewWithANewConnection) {
  flag(99, true, false, 0);
  send(100, "ab", 1);
  send(104, "ef", 1);
  flag(5'000'000, true, false, 2);
  send(5'000'001, "new", 3);
  EXPECT_EQ(out_.text, "ab|ef|new");
  EXPECT_EQ(stream_.counts().connections, 2U);
  flag(5'000'000, true, false, 4);
  EXPECT_EQ(stream_.counts().connections, 2U) << "the same handshake again";
}

TEST_F(TcpStreamTest, TakesANewConnectionThatBeginsWithTheSameNumber) {
  flag(99, true, false, 0);
  send(100, "ab", 1);
  end(102, 2);
  flag(99, true, false, 3);
  send(100, "cd", 4);
  flag(102, false, true, 5);
  flag(99, true, false, 6);
  send(100, "ef", 7);
  flag(99, true, false, 8 + kWait);  // nobody had ended the one before
  send(100, "gh", 9 + kWait);
  EXPECT_EQ(out_.text, "ab|cd|ef|gh");
  EXPECT_EQ(stream_.counts().connections, 4U);
  EXPECT_EQ(stream_.counts().repeated_segments, 0U);
}

TEST_F(TcpStreamTest, TakesAnUnansweredHandshakeThatIsTriedAgainForTheSame) {
  constexpr std::int64_t kMinute = 60'000'000'000;
  flag(99, true, false, 0);
  flag(99, true, false, kMinute);
  send(100, "ab", kMinute + 1);
  EXPECT_EQ(out_.text, "ab");
  EXPECT_EQ(stream_.counts().connections, 1U);
}

TEST_F(TcpStreamTest, EndsAtAResetAndGoesOnWithTheNextHandshake) {
  send(100, "ab", 1);
  send(104, "ef", 1);
  flag(102, false, true, 2);
  EXPECT_EQ(out_.text, "ab|ef");
  flag(9, true, false, 3);
  send(10, "new", 4);
  EXPECT_EQ(out_.text, "ab|ef|new");
}

TEST_F(TcpStreamTest, DropsASegmentThatFitsNowhere) {
  send(100, "ab", 1);
  send(0x7000'0000, "XX", 2);
  EXPECT_EQ(stream_.waiting_since(), 2);
  send(102, "cd", 3);
  send(104, "ef", 4);
  EXPECT_EQ(out_.text, "abcdef");
  stream_.expire(10 + kWait);
  EXPECT_FALSE(stream_.waiting_since());
  EXPECT_EQ(stream_.counts().out_of_window, 1U);
}

TEST_F(TcpStreamTest, FollowsANewConnectionWhoseHandshakeWasNotCaptured) {
  send(100, "ab", 1);
  send(0x7000'0000, "ne", 2);
  send(0x7000'0002, "w", 3);
  EXPECT_EQ(out_.text, "ab|new");
  EXPECT_THAT(out_.times, ElementsAre(1, 1, 2, 2, 3));
}

TEST_F(TcpStreamTest, DoesNotWaitForBytesThatTheCaptureCutOff) {
  send(100, "ab", 1, 10);
  send(112, "mn", 2);
  EXPECT_EQ(out_.text, "ab|mn");
  EXPECT_EQ(stream_.counts().lost_bytes, 10U);
}

TEST_F(TcpStreamTest, IgnoresProbesThatKeepAConnectionAlive) {
  send(100, "ab", 1);
  send(101, "b", 2);
  send(102, "", 3);
  send(102, "cd", 4);
  EXPECT_EQ(out_.text, "abcd");
}

TEST(TcpStreamAtRandom, GivesEveryByteOnceInOrderAtItsFirstTime) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::string text(400, ' ');
    std::iota(text.begin(), text.end(), '\0');
    const auto begin = static_cast<std::uint32_t>(random());
    struct Piece {
      std::uint32_t at, size;
    };
    std::vector<Piece> pieces;
    for (std::uint32_t at = 0; at < text.size();) {
      const auto size =
          std::min<std::uint32_t>(1 + random() % 30, static_cast<std::uint32_t>(text.size()) - at);
      pieces.push_back({at, size});
      at += size;
    }
    for (int i = 0; i < 20; ++i) {  // repetitions and overlaps
      const auto at = static_cast<std::uint32_t>(random() % 390);
      pieces.push_back({at, static_cast<std::uint32_t>(1 + random() % 10)});
    }
    std::shuffle(pieces.begin(), pieces.end(), random);
    Recorder out;
    TcpStream stream(out, 1'000'000);
    stream.take({.sequence = begin - 1, .syn = true}, -1);
    std::vector<std::int64_t> first(text.size(), -1);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto [at, size] = pieces[i];
      for (std::uint32_t k = at; k < at + size; ++k) {
        if (first[k] < 0) first[k] = static_cast<std::int64_t>(i);
      }
      stream.take({.sequence = begin + at, .payload = as_bytes(std::string_view(text).substr(at, size))},
                  static_cast<std::int64_t>(i));
    }
    ASSERT_EQ(out.text, text) << "seed " << seed;
    ASSERT_EQ(out.times, first) << "seed " << seed;
  }
}

}  // namespace
}  // namespace crisp
