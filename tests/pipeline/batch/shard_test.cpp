// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/shard.hpp"

#include <gtest/gtest.h>

#include <map>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::batch;

TEST(Shard, OfSeveralTakeEachNameOnceAndAboutAsMany) {
  constexpr std::uint64_t kCount = 7;
  std::map<std::uint64_t, int> taken;
  for (int i = 0; i < 7000; ++i) {
    const std::string name = "site/r" + std::to_string(i);
    int takers = 0;
    for (std::uint64_t number = 1; number <= kCount; ++number) {
      if (!Shard{number, kCount}.has(name)) continue;
      ++takers;
      ++taken[number];
    }
    EXPECT_EQ(takers, 1) << name;
  }
  // Binomial with a standard deviation of 29: six of them.
  for (const auto& [number, count] : taken) EXPECT_NEAR(count, 1000, 180) << number;
}

TEST(Shard, OfANameIsTheSameOnEveryMachine) {
  // By the definition of FNV-1a and of the finalizer of MurmurHash3, worked out in Python.
  EXPECT_TRUE((Shard{343, 1000}.has("")));
  EXPECT_TRUE((Shard{316, 1000}.has("a")));
  EXPECT_TRUE((Shard{327, 1000}.has("site/r1")));
}

TEST(Shard, IsReadFromItsText) {
  EXPECT_EQ(parse_shard("3/64").number, 3U);
  EXPECT_EQ(parse_shard("3/64").count, 64U);
  EXPECT_EQ(parse_shard("3/64").text(), "3/64");
  for (const char* text : {"", "3", "0/4", "5/4", "-1/4", "1/0", "1/2/3", "a/b"})
    EXPECT_THROW(parse_shard(text), Error) << text;
}

}  // namespace
}  // namespace crisp
