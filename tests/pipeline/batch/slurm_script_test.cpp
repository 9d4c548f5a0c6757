// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/slurm_script.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string read(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(SlurmScript, HasTheValuesInItsDirectivesBeforeTheFirstCommand) {
  const std::string script = complete_slurm_script(kSlurmBatchScript, {.options = {{"array", "1-6"},
                                                                                   {"partition", "long"},
                                                                                   {"chdir", "/a b"},
                                                                                   {"exclusive", ""},
                                                                                   {"requeue", ""}},
                                                                       .program = "/opt/crisp",
                                                                       .words = {"p.yaml"}});
  EXPECT_THAT(script, StartsWith("#!/bin/bash\n"));
  EXPECT_THAT(script, HasSubstr("\n#SBATCH --array=1-6\n"));
  EXPECT_THAT(script, Not(HasSubstr("#SBATCH --array=1-64")));
  EXPECT_THAT(script, HasSubstr("\n#SBATCH --partition=long\n"));
  EXPECT_THAT(script, HasSubstr("\n#SBATCH --chdir=\"/a b\"\n"));
  EXPECT_THAT(script, HasSubstr("\n#SBATCH --exclusive\n"));
  EXPECT_EQ(script.find("#SBATCH --requeue"), script.rfind("#SBATCH --requeue"));
  EXPECT_LT(script.rfind("#SBATCH"), script.find("\nCRISP=/opt/crisp\n")) << "sbatch reads no further";
  EXPECT_THAT(script, EndsWith("\nexec \"${CRISP:-crisp}\" batch \"$@\"\n"));
}

/// Bash itself prints the program's arguments.
TEST(SlurmScript, GivesTheProgramItsWordsUnchanged) {
  const test::TemporaryFolder folder;
  const auto program = folder.path() / "a program";
  std::ofstream(program) << "#!/bin/sh\nprintf '%s\\n' \"$@\"\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::vector<std::string> words = {"p.yaml", "-i",  "cap tures/**/*.pcap", "it's", "$HOME",
                                          "",       "a=b", R"("q" \ ; `x`)",      "ä"};
  std::ofstream(folder.path() / "script") << complete_slurm_script(
      kSlurmBatchScript, {.options = {}, .program = program.string(), .words = words});
  const std::string shell =
      "bash '" + (folder.path() / "script").string() + "' > '" + (folder.path() / "output").string() + "'";
  ASSERT_EQ(std::system(shell.c_str()), 0);
  std::string expected = "batch\n";
  for (const auto& word : words) expected += word + "\n";
  EXPECT_EQ(read(folder.path() / "output"), expected);
}

TEST(SlurmScript, OfAMergeHasTheExitStatusOfTheTable) {
  const test::TemporaryFolder folder;
  const auto program = folder.path() / "crisp";
  std::ofstream(program) << "#!/bin/sh\necho \"$@\"\ntest $2 != table || exit 3\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  std::ofstream(folder.path() / "script") << complete_slurm_script(
      kSlurmMergeScript, {.options = {}, .program = program.string(), .words = {"results"}});
  const std::string shell =
      "bash '" + (folder.path() / "script").string() + "' > '" + (folder.path() / "output").string() + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(shell.c_str())), 3);
  EXPECT_EQ(read(folder.path() / "output"), "batch status results\n");
}

TEST(SlurmScript, LeavesNoPercentSignOfALogsFolderToSlurm) {
  EXPECT_EQ(slurm_log_path("/a%b/log"), "/a%%b/log");
}

TEST(SlurmScript, TakesTheLimitOfArraysFromTheConfiguration) {
  EXPECT_EQ(
      longest_slurm_array("Configuration data as of …\nMaxArraySize            = 1001\nMaxJobCount = 5\n"),
      1000U)
      << "the highest index is below it";
  EXPECT_FALSE(longest_slurm_array("MaxJobCount = 5\n"));
}

}  // namespace
}  // namespace crisp
