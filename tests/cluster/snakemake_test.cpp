// SPDX-License-Identifier: BSD-3-Clause
// The Snakefile of the documentation.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "tests/pipeline/app/batch_fixture.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
namespace fs = std::filesystem;
using testing::Each;
using testing::Pair;
using testing::SizeIs;

class SnakemakeTest : public BatchTest {
 protected:
  void SetUp() override {
    if (std::system("command -v snakemake > /dev/null") != 0)
      GTEST_SKIP() << "not installed: snakemake (package snakemake)";
    const std::string page = read_text_file(fs::path(source_dir()) / "docs/how-to/batch.md", 1 << 20);
    const std::string fence = "```snakemake\n";
    const std::size_t begin = page.find(fence) + fence.size();
    write_file(folder_ / "Snakefile", page.substr(begin, page.find("```", begin) - begin));
  }

  /// As a user runs it who has crisp installed, with the toy stages.
  int snakemake() const {
    const std::string bin = fs::path(CRISP_PROGRAM).parent_path().string();
    const std::string command =
        "cd " + folder_.string() + " && HOME=" + folder_.string() + " XDG_CACHE_HOME=" + path("cache") +
        " PATH=" + bin + ":$PATH CRISP_PLUGINS=" TOY_PLUGIN +
        " snakemake --cores 2 --config pipeline=perform.yaml input=in output=out tasks=3 > log 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }
};

TEST_F(SnakemakeTest, RunsTheSnakefileOfTheDocumentation) {
  for (int i = 0; i < 12; ++i) put("r" + std::to_string(i) + ".pcap", i == 5 ? "caveat" : "done");
  ASSERT_EQ(snakemake(), 0) << content("log");
  EXPECT_THAT(calls(), SizeIs(12));
  EXPECT_THAT(calls(), Each(Pair(testing::_, 1)));
  EXPECT_EQ(field("r4", "status"), "done");
  EXPECT_EQ(field("r5", "status"), "untrusted");
}

TEST_F(SnakemakeTest, ReportsAFailedRecordingAsAFailure) {
  for (int i = 0; i < 6; ++i) put("r" + std::to_string(i) + ".pcap", i == 5 ? "fail" : "done");
  EXPECT_NE(snakemake(), 0);
  EXPECT_EQ(calls()["r5.pcap"], 1) << "it would fail again";
}

}  // namespace
}  // namespace crisp
