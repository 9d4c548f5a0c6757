// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/blocks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>

namespace crisp {
namespace {

using namespace crisp::quality;

/// Counted in parallel, in a loop within another's.
std::size_t counted(std::size_t n) {
  std::vector<std::size_t> ones(n);
  for_each_index(n, [&](std::size_t i) { ones[i] = 1; });
  return std::accumulate(ones.begin(), ones.end(), std::size_t{0});
}

TEST(Blocks, OfALoopThatIsGivenUpAreNotTakenForAll) {
  constexpr std::size_t kMany = 200;
  for (std::size_t bad = 0; bad < kMany; ++bad) {
    std::atomic<bool> is_whole = true;
    std::string reported;
    try {
      for_each_index(kMany, [&](std::size_t i) {
        if (i == bad) throw std::runtime_error("the one that is bad");
        if (counted(kMany) != kMany) is_whole = false;
      });
    } catch (const std::exception& error) {
      reported = error.what();
    }
    EXPECT_EQ(reported, "the one that is bad");
    EXPECT_TRUE(is_whole);
  }
}

}  // namespace
}  // namespace crisp
