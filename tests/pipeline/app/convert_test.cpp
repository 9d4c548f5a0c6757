// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/cloud_conversion.hpp>

#include "pipeline/pcd/parts.hpp"
#include "tests/pipeline/app/program_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::pcd;
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class ConvertTest : public ProgramTest {
 protected:
  static Cloud cloud(std::size_t points) {
    Cloud made;
    made.header.stamp = 1'700'000'000'000'000;
    for (std::size_t i = 0; i < points; ++i) {
      made.push_back(Point());
      made.back().x = static_cast<float>(i);
    }
    return made;
  }
  void put_cloud(std::string_view name, std::size_t points) const {
    PartsWriter writer(folder_ / name, PcdFormat::binary);
    writer.write(to_pcd_table(cloud(points)), false);
    writer.commit();
  }
};

TEST_F(ConvertTest, WritesTheFormatOfTheFileExtension) {
  put_cloud("cloud.pcd", 3);
  for (const auto& [name, begin] : std::map<std::string, std::string>{
           {"a.las", "LASF"}, {"b.ply", "ply\n"}, {"c.pcd", "# .PCD"}, {"D.LAS", "LASF"}}) {
    const auto run = crisp({"convert", path("cloud.pcd"), path(name), "--quiet"});
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(content(name), StartsWith(begin));
    EXPECT_EQ(json(name + ".provenance.json")["inputs"][0]["file"], path("cloud.pcd"));
  }
}

TEST_F(ConvertTest, WritesEachCloudOfAFolderIntoAFolder) {
  fs::create_directory(folder_ / "clouds");
  put_cloud("clouds/one.pcd", 3);
  PartsWriter parts(folder_ / "clouds/two.pcd", PcdFormat::binary);
  parts.write(to_pcd_table(cloud(4)), true);
  parts.write(to_pcd_table(cloud(5)), false);
  parts.commit();
  const auto run = crisp({"convert", path("clouds"), path("out"), "--format", "las"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("3 points in " + path("out/one.las")));
  EXPECT_THAT(run.out, HasSubstr("9 points in " + path("out/two.las")));
  EXPECT_FALSE(fs::exists(folder_ / "out/two_0002.las"));
}

TEST_F(ConvertTest, GoesOnAfterAFileThatIsNoCloud) {
  fs::create_directory(folder_ / "clouds");
  write_file(folder_ / "clouds/a.pcd", "no cloud");
  put_cloud("clouds/b.pcd", 3);
  const auto run = crisp({"convert", path("clouds"), path("out"), "--format", "ply"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("a.pcd"));
  EXPECT_TRUE(fs::exists(folder_ / "out/b.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "out/a.ply"));
}

TEST_F(ConvertTest, RefusesAnEndingThatIsNoCloudsAndAFolderWithoutAFormat) {
  put_cloud("cloud.pcd", 3);
  const auto ending = crisp({"convert", path("cloud.pcd"), path("cloud.xyz")});
  EXPECT_EQ(ending.status, 2);
  EXPECT_THAT(ending.error, HasSubstr("end the name in .pcd, .ply or .las"));
  const auto folder = crisp({"convert", path(""), path("out")});
  EXPECT_EQ(folder.status, 2);
  EXPECT_THAT(folder.error, HasSubstr("give --format las"));
}

}  // namespace
}  // namespace crisp
