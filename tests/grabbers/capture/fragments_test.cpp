// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/fragments.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::devices;
using namespace crisp::wire;

Bytes numbered(std::size_t n) {
  Bytes bytes(n);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

IpPacket fragment(ByteView whole, std::uint32_t begin, std::uint32_t end, std::uint32_t id = 1) {
  return {.protocol = 17,
          .payload = whole.subspan(begin, end - begin),
          .more_fragments = end < whole.size(),
          .fragment_offset = begin,
          .id = id};
}

TEST(FragmentAssembler, JoinsFragmentsInAnyOrder) {
  const auto whole = numbered(100);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> parts{{0, 24}, {24, 48}, {48, 96}, {96, 100}};
  do {
    FragmentAssembler assembler;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto found = assembler.take(fragment(whole, parts[i].first, parts[i].second), 0);
      ASSERT_EQ(found.has_value(), i + 1 == parts.size());
      if (!found) continue;
      EXPECT_EQ(Bytes(found->payload.begin(), found->payload.end()), whole);
      EXPECT_FALSE(found->is_fragment());
    }
    assembler.finish();
    EXPECT_TRUE(assembler.losses().all().empty());
  } while (std::next_permutation(parts.begin(), parts.end()));
}

TEST(FragmentAssembler, CopesWithOverlapsAndRepetitions) {
  const auto whole = numbered(100);
  FragmentAssembler assembler;
  for (const auto& [begin, end] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 48}, {0, 48}, {40, 64}, {48, 56}}) {
    EXPECT_FALSE(assembler.take(fragment(whole, begin, end), 0));
  }
  const auto found = assembler.take(fragment(whole, 56, 100), 0);
  ASSERT_TRUE(found);
  EXPECT_EQ(Bytes(found->payload.begin(), found->payload.end()), whole);
}

TEST(FragmentAssembler, KeepsPacketsApart) {
  const auto a = numbered(16), b = Bytes(16, 7);
  FragmentAssembler assembler;
  EXPECT_FALSE(assembler.take(fragment(a, 0, 8, 1), 0));
  EXPECT_FALSE(assembler.take(fragment(b, 8, 16, 2), 0));
  EXPECT_EQ(assembler.take(fragment(a, 8, 16, 1), 0)->payload[8], 8);
  EXPECT_EQ(assembler.take(fragment(b, 0, 8, 2), 0)->payload[0], 7);
}

TEST(FragmentAssembler, CountsWhatNeverBecameWhole) {
  const auto whole = numbered(16);
  FragmentAssembler assembler;
  for (std::uint32_t id = 0; id < 100; ++id) assembler.take(fragment(whole, 0, 8, id), id);
  EXPECT_EQ(assembler.losses().of(FragmentAssembler::kIncomplete), 36U) << "no more than 64 at a time";
  assembler.take(fragment(whole, 0, 8, 200), 40'000'000'000);
  EXPECT_EQ(assembler.losses().of(FragmentAssembler::kIncomplete), 100U) << "none for longer than 30 s";
  assembler.finish();
  EXPECT_EQ(assembler.losses().of(FragmentAssembler::kIncomplete), 101U);
}

TEST(FragmentAssembler, RefusesFragmentsBeyondTheLargestPacket) {
  const auto whole = Bytes(8, 1);
  auto beyond = fragment(whole, 0, 8);
  beyond.fragment_offset = 65528;
  beyond.more_fragments = true;
  FragmentAssembler assembler;
  EXPECT_FALSE(assembler.take(beyond, 0));
  EXPECT_EQ(assembler.losses().of(FragmentAssembler::kIncomplete), 1U);
}

}  // namespace
}  // namespace crisp
