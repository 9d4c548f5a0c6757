// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/batcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <numeric>
#include <stdexcept>

namespace crisp {
namespace {

using namespace crisp::data;

using Numbers = std::vector<int>;

TEST(Batcher, WorksOnEverythingInItsOrder) {
  Numbers done;
  Batcher<int> batcher({.enough = 3, .most = 10}, [&](const Numbers& batch) {
    EXPECT_FALSE(batch.empty());
    done.insert(done.end(), batch.begin(), batch.end());
  });
  Numbers pushed(1000);
  std::iota(pushed.begin(), pushed.end(), 0);
  for (const int number : pushed) batcher.push(number);
  batcher.drain();
  EXPECT_EQ(done, pushed);
}

TEST(Batcher, LetsNobodyWaitUntilSomebodyPushesMoreThanMayWait) {
  std::promise<void> goes_on;
  std::atomic<int> batches = 0;
  Batcher<int> batcher({.enough = 1, .most = 2}, [&, on = goes_on.get_future().share()](const Numbers&) {
    ++batches;
    on.wait();
  });
  batcher.push(1);
  while (batches == 0) std::this_thread::yield();
  batcher.push(2);
  batcher.push(3);
  auto fourth = std::async(std::launch::async, [&] { batcher.push(4); });
  EXPECT_EQ(fourth.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  goes_on.set_value();
  fourth.get();
  batcher.drain();
  EXPECT_LE(batches, 3) << "what waited together is worked on together";
}

TEST(Batcher, WorksAfterAPauseOnWhatThereIsAndOnNothing) {
  std::promise<Numbers> first;
  std::promise<Numbers> second;
  int batches = 0;
  Batcher<int> batcher({.enough = 1000, .most = 1000, .pause = 0.02}, [&](Numbers batch) {
    if (batch.empty() && batches == 0) return;  // the machine was busy before the push
    if (++batches > 2) return;
    (batches == 1 ? first : second).set_value(std::move(batch));
  });
  batcher.push(7);
  EXPECT_EQ(first.get_future().get(), Numbers{7});
  EXPECT_EQ(second.get_future().get(), Numbers{});
}

TEST(Batcher, ThrowsWhatTheWorkThrewToWhoeverComesNext) {
  Batcher<int> batcher({}, [](const Numbers&) { throw std::runtime_error("the disk is full"); });
  batcher.push(1);
  EXPECT_THROW(batcher.drain(), std::runtime_error);
  EXPECT_THROW(batcher.push(2), std::runtime_error);
  EXPECT_THROW(batcher.drain(), std::runtime_error);
}

TEST(Batcher, EndsWithoutWhatWaits) {
  int worked = 0;
  {
    Batcher<int>({.enough = 10, .most = 10}, [&](const Numbers&) { ++worked; }).push(1);
  }
  EXPECT_EQ(worked, 0);
}

}  // namespace
}  // namespace crisp
