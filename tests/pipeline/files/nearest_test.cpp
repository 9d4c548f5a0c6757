// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/nearest.hpp"

#include <gmock/gmock.h>

namespace crisp {
namespace {

using namespace crisp::files;
using testing::Optional;

TEST(NearestName, FindsTheNameThatWasMeant) {
  const std::vector<std::string> known = {"sigma", "search", "radius", "r"};
  EXPECT_THAT(nearest_name("sgima", known), Optional(std::string("sigma")));  // one swap
  EXPECT_THAT(nearest_name("radus", known), Optional(std::string("radius")));
  EXPECT_THAT(nearest_name("serach", known), Optional(std::string("search")));
}

TEST(NearestName, DoesNotGuessWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("temperature", {"sigma", "radius"}), std::nullopt);
  EXPECT_EQ(nearest_name("", {"sigma"}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), {"sigma"}), std::nullopt);
  EXPECT_EQ(did_you_mean("temperature", {"sigma"}, "see the list"), "see the list");
}

}  // namespace
}  // namespace crisp
