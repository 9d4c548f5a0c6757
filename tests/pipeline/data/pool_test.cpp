// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/pool.hpp"

#include <gtest/gtest.h>

#include <set>
#include <thread>

namespace crisp {
namespace {

using namespace crisp::data;

using Values = std::vector<int>;

TEST(Pool, FillsAnewWhatNobodyHoldsAnyMore) {
  Pool<Values> pool;
  auto first = pool.get();
  first->assign(100, 1);
  const Values* place = first.get();
  first.reset();
  const auto second = pool.get();
  EXPECT_EQ(second.get(), place);
  EXPECT_GE(second->capacity(), 100U);
}

TEST(Pool, NeverGivesOutWhatSomebodyHolds) {
  Pool<Values> pool;
  const auto first = pool.get();
  const std::shared_ptr<const Values> same = first;
  EXPECT_NE(pool.get(), first);
}

TEST(Pool, MayBeOutlivedByWhatItGave) {
  std::shared_ptr<Values> held;
  {
    Pool<Values> pool;
    held = pool.get();
  }
  held->assign(3, 7);
  EXPECT_EQ(*held, Values({7, 7, 7}));
}

TEST(Pool, TakesBackFromAnyThreadAndKeepsNoMoreThanWereHeldAtATime) {
  Pool<Values> pool;
  std::set<const Values*> seen;
  for (int round = 0; round < 1000; ++round) {
    auto one = pool.get();
    auto other = pool.get();
    seen.insert({one.get(), other.get()});
    std::thread([mine = std::move(one)]() mutable { mine.reset(); }).join();
  }
  EXPECT_EQ(seen.size(), 2U);
}

TEST(Pool, IsFilledInOneThreadWhileAnotherEmptiesIt) {
  Pool<Values> pool;
  std::mutex mutex;
  std::vector<std::shared_ptr<const Values>> on_their_way;
  std::thread filling([&] {
    for (int i = 0; i < 10'000; ++i) {
      auto values = pool.get();
      values->assign(10, i);
      const std::lock_guard lock(mutex);
      on_their_way.push_back(std::move(values));
    }
  });
  int come = 0;
  while (come < 10'000) {
    std::vector<std::shared_ptr<const Values>> taken;
    {
      const std::lock_guard lock(mutex);
      taken.swap(on_their_way);
    }
    for (const auto& values : taken) ASSERT_EQ(*values, Values(10, come++));
    std::this_thread::yield();
  }
  filling.join();
}

}  // namespace
}  // namespace crisp
