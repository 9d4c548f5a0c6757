// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/recording.hpp"

#include <gmock/gmock.h>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/batch/glob.hpp"
#include "pipeline/batch/output_name.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class RecordingsTest : public testing::Test {
 protected:
  void put(const std::string& name) const { write_file(folder_ / name, ""); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  BatchInputs inputs(const std::vector<std::string>& given) const {
    std::vector<std::string> paths;
    for (const auto& one : given) paths.push_back(path(one));
    return {.given = paths, .output = folder_ / "out", .extensions = {".pcap", ".pcd"}};
  }
  std::vector<std::string> names(const BatchInputs& of) const {
    std::vector<std::string> names;
    for (const auto& recording : find_recordings(of)) names.push_back(recording.name);
    return names;
  }
  std::vector<std::string> names(const std::vector<std::string>& given) const { return names(inputs(given)); }

  test::TemporaryFolder folder_;
};

TEST_F(RecordingsTest, OfAFolderAreItsFilesOfKnownKindsByTheirPaths) {
  for (const char* name : {"in/b.pcap", "in/a/c.pcd", "in/a/.d.pcd", "in/.e/f.pcd", "in/notes.md"}) put(name);
  EXPECT_THAT(names({"in"}), ElementsAre("a/c", "b"));
  EXPECT_THAT(names({"in/"}), ElementsAre("a/c", "b"));
}

TEST_F(RecordingsTest, AreNotSoughtAmongTheResults) {
  put("a.pcap");
  put("out/a/cloud.pcd");
  EXPECT_THAT(names(inputs({""})), ElementsAre("a"));
  EXPECT_THAT(names({"**/*.p*"}), ElementsAre("a"));
}

TEST_F(RecordingsTest, OfAPatternAreNamedFromItsFirstWildcardOn) {
  for (const char* name : {"in/x/1.pcap", "in/x/y/2.pcap", "in/3.pcap", "in/4.pcd"}) put(name);
  EXPECT_THAT(names({"in/**/*.pcap"}), ElementsAre("3", "x/1", "x/y/2"));
  EXPECT_THAT(names({"in/*/*.pcap"}), ElementsAre("x/1"));
  EXPECT_THROW(names({"in/*.csv"}), Error);
}

TEST_F(RecordingsTest, OfAListAreRelativeToItAndMayBeMissing) {
  put("in/x/1.pcap");
  write_file(folder_ / "in/list.txt", "# two\nx/1.pcap\r\n\nx/2.pcap\n");
  const auto found = find_recordings(inputs({"in/list.txt"}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].name, "x/1");
  EXPECT_EQ(found[0].unreadable, "");
  EXPECT_EQ(found[1].unreadable, "there is no such file");
}

TEST_F(RecordingsTest, OfSeveralInputsAreTakenOnce) {
  put("in/1.pcap");
  EXPECT_THAT(names({"in", "in/1.pcap", "in/*.pcap"}), ElementsAre("1"));
}

TEST_F(RecordingsTest, AreFoldersWhereEachIsOne) {
  for (const char* name : {"in/x/1.pcap", "in/x/2.pcap", "in/y/z/3.pcap", "in/w/notes.md"}) put(name);
  auto each = inputs({"in"});
  each.unit = BatchUnit::folder;
  EXPECT_THAT(names(each), ElementsAre("x", "y/z"));
  EXPECT_TRUE(find_recordings(each).front().is_folder);
}

TEST_F(RecordingsTest, AreNamedRelativeToTheBaseThatIsGiven) {
  put("in/x/1.pcap");
  put("in/y/1.pcap");
  const std::vector<std::string> both = {"in/x/1.pcap", "in/y/1.pcap"};
  EXPECT_THROW(names(both), Error);
  auto with_base = inputs(both);
  with_base.base = folder_ / "in";
  EXPECT_THAT(names(with_base), ElementsAre("x/1", "y/1"));
  with_base.base = folder_ / "in/x";
  EXPECT_THROW(names(with_base), Error);
}

TEST_F(RecordingsTest, ThatWouldShareAnOutputAreRefusedAllAtOnce) {
  for (const char* name :
       {"in/a.pcap", "in/a.pcd", "in/b.pcap", "in/b/c/d.pcap", "in/b-1.pcap", "in/manifest.pcap"})
    put(name);
  try {
    names({"in"});
    FAIL() << "nothing was refused";
  } catch (const Errors& errors) {
    ASSERT_EQ(errors.all().size(), 3U);
    EXPECT_THAT(errors.all()[0].what(), HasSubstr("would share the output a;"));
    EXPECT_THAT(errors.all()[1].what(), HasSubstr("b/c/d.pcap would share the output b;"));
    EXPECT_THAT(errors.all()[2].what(), HasSubstr("belongs to the batch itself"));
  }
}

TEST_F(RecordingsTest, FollowLinksButNotInCircles) {
  put("in/a/1.pcap");
  fs::create_directory_symlink("..", folder_ / "in/a/up");
  fs::create_directory_symlink(folder_ / "in/a", folder_ / "in/b");
  EXPECT_THAT(names({"in"}), ElementsAre("a/1", "b/1"));
}

TEST(OutputName, KeepsUtf8AndWritesOtherBytesAsPercentSigns) {
  EXPECT_EQ(output_name("a/Büro 5%"), "a/Büro 5%");
  EXPECT_EQ(output_name("a\nb%"), "a%0Ab%25");
  EXPECT_EQ(output_name("a\xff"), "a%FF");
}

TEST(Pattern, HasAFixedPart) {
  EXPECT_TRUE(is_pattern("a/*.pcap"));
  EXPECT_FALSE(is_pattern("a/b.pcap"));
  EXPECT_EQ(fixed_part("/a/b/**/c/*.pcap"), "/a/b");
  EXPECT_EQ(fixed_part("*.pcap"), "");
}

}  // namespace
}  // namespace crisp
