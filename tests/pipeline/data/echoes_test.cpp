// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/echoes.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace crisp {
namespace {

using namespace crisp::data;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Three echoes of four beams: all there; the first missing; the last alone; none.
std::shared_ptr<const Scan> three_echoes() {
  auto scan = std::make_shared<Scan>();
  scan->serial_number = 77;
  scan->echoes = {{.ranges = {1, 0, kInfinity, 0}, .remissions = {10, 99, 99, 99}},
                  {.ranges = {2, 5, 0, 0}, .remissions = {30, 40, 99, 99}},
                  {.ranges = {3, 6, 8, 0}, .remissions = {20, 50, 60, 99}}};
  return scan;
}

struct Used {
  std::shared_ptr<const Scan> scan;
  EchoCounts counts;
};

Used used(EchoChoice choice) {
  Used result;
  result.scan = with_used_echoes(three_echoes(), choice, result.counts);
  return result;
}

TEST(Echoes, FirstIsTheFirstThatCameBack) {
  const Used first = used(EchoChoice::first);
  ASSERT_EQ(first.scan->echoes.size(), 1U);
  EXPECT_THAT(first.scan->echoes[0].ranges, ElementsAre(1, 5, 8, 0));
  EXPECT_THAT(first.scan->echoes[0].remissions, ElementsAre(10, 40, 60, 0));
  EXPECT_EQ(first.scan->serial_number, 77U);
  EXPECT_EQ(first.counts.later, 2U);
  EXPECT_EQ(first.counts.unused, 3U);
}

TEST(Echoes, LastAndStrongestAreOneOfThoseThatCameBack) {
  EXPECT_THAT(used(EchoChoice::last).scan->echoes[0].ranges, ElementsAre(3, 6, 8, 0));
  const Used strongest = used(EchoChoice::strongest);
  EXPECT_THAT(strongest.scan->echoes[0].ranges, ElementsAre(2, 6, 8, 0));
  EXPECT_THAT(strongest.scan->echoes[0].remissions, ElementsAre(30, 50, 60, 0));
}

TEST(Echoes, AllComeWithoutEmptyOnesBeforeThem) {
  const Used all = used(EchoChoice::all);
  ASSERT_EQ(all.scan->echoes.size(), 3U);
  EXPECT_THAT(all.scan->echoes[0].ranges, ElementsAre(1, 5, 8, 0));
  EXPECT_THAT(all.scan->echoes[1].ranges, ElementsAre(2, 6, 0, 0));
  EXPECT_THAT(all.scan->echoes[2].ranges, ElementsAre(3, 0, 0, 0));
  EXPECT_EQ(all.counts.unused, 0U);
}

TEST(Echoes, StrongestWithoutRemissionsIsTheFirst) {
  Scan scan = *three_echoes();
  for (Echo& echo : scan.echoes) echo.remissions.clear();
  EchoCounts counts;
  const auto result = with_used_echoes(std::make_shared<Scan>(scan), EchoChoice::strongest, counts);
  EXPECT_THAT(result->echoes[0].ranges, ElementsAre(1, 5, 8, 0));
  EXPECT_THAT(result->echoes[0].remissions, IsEmpty());
}

TEST(Echoes, AScanOfOneEchoStaysAsItIs) {
  auto scan = std::make_shared<Scan>();
  scan->echoes = {{.ranges = {1, 0}}};
  EchoCounts counts;
  EXPECT_EQ(with_used_echoes(scan, EchoChoice::last, counts).get(), scan.get());
}

}  // namespace
}  // namespace crisp
