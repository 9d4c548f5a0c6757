// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/cola_framer.hpp"

#include <gmock/gmock.h>

#include "tests/grabbers/wire/samples.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;
using testing::ElementsAre;

void append(Bytes& stream, ByteView bytes) { stream.insert(stream.end(), bytes.begin(), bytes.end()); }

std::vector<std::string> texts(const std::vector<FoundTelegram>& found) {
  std::vector<std::string> out;
  for (const auto& telegram : found) out.emplace_back(as_text(telegram.payload));
  return out;
}

/// Both languages in turn, among them a scan full of bytes 02 and 03.
Bytes mixed_stream() {
  Bytes stream;
  auto scan = full_scan_data(1);
  for (auto& value : scan.channels16[0].raw) value = value % 2 == 0 ? 0x0202 : 0x0203;
  for (int i = 0; i < 3; ++i) {
    append_cola_frame(as_bytes("sRA SCdevicestate 1"), ColaLanguage::A, stream);
    append(stream, encode_scan_data(scan, ColaLanguage::B));
    append_cola_frame(as_bytes("sWA LMDscandatacfg "), ColaLanguage::B, stream);
    append(stream, encode_scan_data(scan, ColaLanguage::A));
  }
  return stream;
}

TEST(ColaFramer, FindsBothLanguagesInOneStream) {
  Bytes stream;
  append_cola_frame(as_bytes("sRN SCdevicestate"), ColaLanguage::A, stream);
  append_cola_frame(as_bytes("sRN SCdevicestate"), ColaLanguage::B, stream);
  const auto found = find_telegrams(stream);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].language, ColaLanguage::A);
  EXPECT_EQ(found[1].language, ColaLanguage::B);
  EXPECT_THAT(texts(found), ElementsAre("sRN SCdevicestate", "sRN SCdevicestate"));
}

TEST(ColaFramer, FindsTheSameWhereverTheStreamIsSplit) {
  const auto stream = mixed_stream();
  const auto whole = find_telegrams(stream);
  ASSERT_EQ(whole.size(), 12U);
  for (std::size_t split = 0; split <= stream.size(); ++split) {
    ColaFramer framer;
    std::vector<FoundTelegram> found;
    const auto take = [&](const ColaFrame& f) {
      found.push_back({f.language, Bytes(f.payload.begin(), f.payload.end()), 0});
    };
    framer.feed(ByteView(stream).first(split), 0, take);
    framer.feed(ByteView(stream).subspan(split), 0, take);
    ASSERT_EQ(found, whole) << "split at " << split;
  }
  for (const std::size_t piece : {1, 2, 3, 7, 64}) {
    EXPECT_EQ(texts(find_telegrams(stream, piece)), texts(whole)) << "pieces of " << piece;
  }
}

TEST(ColaFramer, BeginsInsideATelegram) {
  const auto stream = mixed_stream();
  const auto whole = texts(find_telegrams(stream));
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    const auto found = texts(find_telegrams(ByteView(stream).subspan(cut)));
    ASSERT_LE(found.size(), whole.size());
    ASSERT_TRUE(std::equal(found.rbegin(), found.rend(), whole.rbegin())) << "begun at " << cut;
  }
}

TEST(ColaFramer, KeepsEveryWholeTelegramOfAStreamCutAnywhere) {
  const auto stream = mixed_stream();
  const auto whole = texts(find_telegrams(stream));
  std::size_t fewest = 0;
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    const auto found = texts(find_telegrams(ByteView(stream).first(cut)));
    ASSERT_TRUE(std::equal(found.begin(), found.end(), whole.begin())) << "cut at " << cut;
    ASSERT_GE(found.size(), fewest);
    fewest = found.size();
  }
  EXPECT_EQ(fewest, whole.size());
}

TEST(ColaFramer, LosesOnlyTheTelegramInWhichABitFlips) {
  Bytes stream;
  for (int i = 0; i < 3; ++i) append(stream, real_telegram("lms111_scan.hex"));
  const std::size_t size = stream.size() / 3;
  const auto whole = find_telegrams(stream)[0].payload;
  for (std::size_t bit = 0; bit < size * 8; ++bit) {
    auto damaged = stream;
    damaged[size + bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    const auto found = find_telegrams(damaged);
    ASSERT_EQ(found.size(), 2U) << "bit " << bit;
    ASSERT_EQ(found[0].payload, whole);
    ASSERT_EQ(found[1].payload, whole);
  }
}

TEST(ColaFramer, CountsWhatItSkipped) {
  Bytes stream = from_hex("00 11 02 02 02 02 ff ff ff ff");
  append_cola_frame(as_bytes("sRN Run"), ColaLanguage::B, stream);
  append(stream, from_hex("02 02 02 02 00 00 00 07 73 52 4e 20 52 75 6e 00"));  // a wrong checksum
  append_cola_frame(as_bytes("sRN Run"), ColaLanguage::A, stream);
  append(stream, from_hex("02 02 02 02 00 00 00 07 73 52"));  // an end that never comes
  ColaFramer::Counts counts;
  EXPECT_EQ(find_telegrams(stream, 1, &counts).size(), 2U);
  EXPECT_EQ(counts.telegrams, 2U);
  EXPECT_EQ(counts.skipped_bytes, 10U + 16U + 10U);
  EXPECT_EQ(counts.resynchronisations, 2U);
  EXPECT_EQ(counts.checksum_failures, 1U);
  EXPECT_EQ(counts.cut, 1U);
}

TEST(ColaFramer, StampsATelegramWithTheLatestOfItsBytes) {
  const auto frame = cola_frame(as_bytes("sRN SCdevicestate"), ColaLanguage::B);
  ColaFramer framer;
  std::vector<std::int64_t> times;
  const auto take = [&](const ColaFrame& f) { times.push_back(f.completed_ns); };
  framer.feed(ByteView(frame).first(5), 300, take);  // came last, but its bytes are the first
  EXPECT_EQ(framer.waiting_since(), 300);
  Bytes rest(frame.begin() + 5, frame.end());
  append(rest, frame);
  framer.feed(rest, 200, take);
  EXPECT_THAT(times, ElementsAre(300, 200));
  EXPECT_FALSE(framer.waiting_since());
}

TEST(ColaFramer, GivesATelegramHiddenByAFalseStartItsOwnTime) {
  ColaFramer framer;
  std::vector<std::int64_t> times;
  const auto take = [&](const ColaFrame& f) { times.push_back(f.completed_ns); };
  framer.feed(from_hex("02 02 02 02 00 00 00 60 73 52 4e"), 1, take);  // claims 96 bytes
  framer.feed(cola_frame(as_bytes("sRN SCdevicestate"), ColaLanguage::A), 2, take);
  EXPECT_TRUE(times.empty());
  EXPECT_EQ(framer.waiting_since(), 1);
  framer.feed(Bytes(100, 'x'), 3, take);
  EXPECT_THAT(times, ElementsAre(2));
}

TEST(ColaFramer, HoldsNoMoreThanOneTelegramOfEndlessGarbage) {
  ColaFramer framer;
  std::size_t found = 0;
  const auto count = [&](const ColaFrame&) { ++found; };
  const auto endless_a = from_hex("02 73 52 4e 20");
  framer.feed(endless_a, 0, count);
  for (int i = 1; i < 200; ++i) framer.feed(Bytes(1000, 'A'), i, count);
  EXPECT_FALSE(framer.waiting_since()) << "a text of more than 64 KiB is given up";
  EXPECT_EQ(found, 0U);
  EXPECT_EQ(framer.counts().skipped_bytes, 5U + 199'000U);
}

}  // namespace
}  // namespace crisp
