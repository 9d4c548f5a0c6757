// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/pcd_inspector.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::pcd_grabber;
using testing::HasSubstr;

/// A cloud as another program writes it.
constexpr std::string_view kCloud = R"(# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y z rgb normal
SIZE 4 4 4 4 4
TYPE F F F U F
COUNT 1 1 1 1 3
WIDTH 3
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS 3
DATA ascii
1 -2 0.5 7 0 0 1
nan 3 0.5 9 0 0 1
-4 1 0.5 8 0 0 1
)";

std::filesystem::path written(const std::string& name, std::string_view text) {
  auto file = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(file) << text;
  return file;
}

TEST(PcdInspector, DescribesAnyProgramsCloud) {
  const Inspection inspection = pcd_inspector().inspect(written("info.pcd", kCloud), {});
  EXPECT_EQ(inspection.data["points"], 3);
  EXPECT_EQ(inspection.data["format"], "ascii");
  const auto& fields = inspection.data["fields"];
  EXPECT_EQ(fields["x"]["least"], -4);
  EXPECT_EQ(fields["x"]["most"], 1);
  EXPECT_EQ(fields["x"]["not_finite"], 1);
  EXPECT_EQ(fields["rgb"]["type"], "U32");
  EXPECT_EQ(fields["normal"]["count"], 3) << "its elements have no single extent";
  EXPECT_THAT(inspection.text, HasSubstr("3 points, ascii"));
  EXPECT_THAT(inspection.text, HasSubstr("1 are no numbers"));
}

TEST(PcdInspector, KnowsACloudByItsHead) {
  EXPECT_TRUE(pcd_inspector().recognises(kCloud));
  EXPECT_TRUE(pcd_inspector().recognises("VERSION 0.7\nFIELDS x y z\n"));
  EXPECT_TRUE(pcd_inspector().recognises("# made by hand\nFIELDS x y z\n"));
  EXPECT_FALSE(pcd_inspector().recognises("crisp: 1\nlasers:\n"));
}

TEST(PcdInspector, RefusesACloudThatEndsEarly) {
  const auto file = written("cut.pcd", kCloud.substr(0, kCloud.size() - 30));
  EXPECT_THROW(pcd_inspector().inspect(file, {}), Error);
}

}  // namespace
}  // namespace crisp
