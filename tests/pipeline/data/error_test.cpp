// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/error.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

TEST(Error, HoldsMessageAndAdviceWithoutTheWordError) {
  EXPECT_STREQ(Error("there is no room", "make some").what(), "there is no room; make some");
  EXPECT_STREQ(Error("there is no room", {}, {"p.yaml", 3, 5}).what(), "p.yaml:3:5: error: there is no room");
}

}  // namespace
}  // namespace crisp
