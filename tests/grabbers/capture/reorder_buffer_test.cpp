// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/reorder_buffer.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace crisp {
namespace {

using namespace crisp::capture;

std::string pop_all(ReorderBuffer<char>& buffer, std::int64_t limit_ns) {
  std::string items;
  while (const auto next = buffer.pop(limit_ns)) items += next->item;
  return items;
}

TEST(ReorderBuffer, GivesItemsByTimeAndEqualTimesAsTheyCame) {
  ReorderBuffer<char> buffer;
  const std::vector<std::int64_t> times = {30, 10, 20, 10, 40, 20, 30};
  for (std::size_t i = 0; i < times.size(); ++i) buffer.push(times[i], static_cast<char>('a' + i));
  EXPECT_EQ(buffer.first_ns(), 10);
  EXPECT_EQ(buffer.last_ns(), 40);
  EXPECT_EQ(pop_all(buffer, 100), "bdcfage");
  EXPECT_TRUE(buffer.empty());
}

TEST(ReorderBuffer, HoldsWhatIsNotBeforeTheLimit) {
  ReorderBuffer<char> buffer;
  buffer.push(20, 'b');
  buffer.push(10, 'a');
  EXPECT_EQ(pop_all(buffer, 10), "");
  EXPECT_FALSE(buffer.has(10));
  EXPECT_TRUE(buffer.has(11));
  EXPECT_EQ(pop_all(buffer, 20), "a");
  buffer.push(15, 'c');
  EXPECT_EQ(pop_all(buffer, 21), "cb");
}

TEST(ReorderBuffer, MovesItemsAndStatesTheirTimes) {
  ReorderBuffer<std::unique_ptr<int>> buffer;
  buffer.push(7, std::make_unique<int>(1));
  buffer.push(5, std::make_unique<int>(2));
  const auto first = buffer.pop();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->time_ns, 5);
  EXPECT_EQ(*first->item, 2);
  EXPECT_EQ(*buffer.pop()->item, 1);
  EXPECT_FALSE(buffer.pop());
}

}  // namespace
}  // namespace crisp
