// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include <crisp/error.hpp>

#include "pipeline/data/exception_to_error.hpp"
#include "pipeline/data/internal_error.hpp"

namespace crisp {
namespace {

using namespace crisp::data;

TEST(Error, HoldsMessageAndAdviceWithoutTheWordError) {
  EXPECT_STREQ(Error("there is no room", "make some").what(), "there is no room; make some");
  EXPECT_STREQ(Error("there is no room", {}, {"p.yaml", 3, 5}).what(), "p.yaml:3:5: error: there is no room");
}

TEST(Error, OfTheProgramAsksForAReport) {
  EXPECT_STREQ(
      internal_error("1 beam has 2 surfaces").what(),
      "1 beam has 2 surfaces: an error of this program; please report it with the command and its input");
}

TEST(Error, OfAnyExceptionHasAdvice) {
  const std::filesystem::filesystem_error denied("status", "/x",
                                                 std::make_error_code(std::errc::permission_denied));
  EXPECT_STREQ(error_of(denied).what(), "/x: Permission denied; check the path and its permissions");
  EXPECT_STREQ(error_of(std::bad_alloc()).what(),
               "the memory is exhausted; give it less data at once, or end other programs");
  EXPECT_STREQ(error_of(Error("there is no room", "make some")).what(), "there is no room; make some");
  const std::system_error busy(std::make_error_code(std::errc::device_or_resource_busy), "/dev/ttyUSB0");
  EXPECT_EQ(error_of(busy).advice(), "remove the cause that the system reports");
  EXPECT_EQ(error_of(std::runtime_error("odd")).advice(), "please report it with the command and its input");
}

}  // namespace
}  // namespace crisp
