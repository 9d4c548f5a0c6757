// SPDX-License-Identifier: BSD-3-Clause
// `crisp cluster submit`, with scripts in the place of Slurm's programs: tests/cluster has Slurm itself.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "pipeline/files/folder_lock.hpp"
#include "tests/pipeline/app/batch_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class ClusterSubmitTest : public BatchTest {
 protected:
  ClusterSubmitTest() : path_(std::getenv("PATH")) {
    fs::create_directory(folder_ / "bin");
    install("scontrol", "echo 'MaxArraySize            = 1001'");
    install("sbatch",
            "echo \"$@\" >> " + path("submitted") + "\necho $((11 + $(wc -l < " + path("submitted") + ")))");
    setenv("PATH", (path("bin") + ":" + path_).c_str(), 1);
    for (int i = 0; i < 9; ++i) put("r" + std::to_string(i) + ".pcap", "done");
  }
  ~ClusterSubmitTest() override { setenv("PATH", path_.c_str(), 1); }

  void install(const std::string& program, const std::string& does) {
    write_file(folder_ / "bin" / program, "#!/bin/sh\n" + does + "\n");
    fs::permissions(folder_ / "bin" / program, fs::perms::owner_all);
  }

  Outcome submit(const std::vector<std::string>& more = {}) {
    std::vector<std::string> all = {
        "cluster", "submit", path("perform.yaml"), "-i", path("in"), "-o", path("out"), "--tasks", "6"};
    all.insert(all.end(), more.begin(), more.end());
    return crisp(all);
  }

  std::string script() const { return content("out/manifest/slurm/batch.sbatch"); }

 private:
  std::string path_;
};

TEST_F(ClusterSubmitTest, SubmitsAnArrayAndAMergeJobThatDependsOnIt) {
  const auto run = submit({"--set", "toy.perform.text=it's", "--cpus", "2", "--sbatch", "partition=long",
                           "--sbatch", "exclusive"});
  EXPECT_EQ(run.status, 0) << run.error;
  const std::string scripts = path("out/manifest/slurm/");
  EXPECT_EQ(content("submitted"), "--parsable " + scripts +
                                      "batch.sbatch\n--parsable --dependency=afterany:12 " + scripts +
                                      "merge.sbatch\n");
  EXPECT_THAT(run.out, HasSubstr("job 12: 6 tasks\njob 13: the table, after them\n"));
  EXPECT_THAT(script(), HasSubstr("\n#SBATCH --array=1-6\n"));
  EXPECT_THAT(script(), HasSubstr("\n#SBATCH --cpus-per-task=2\n"));
  EXPECT_THAT(script(), HasSubstr("\n#SBATCH --partition=long\n"));
  EXPECT_THAT(script(), HasSubstr("\n#SBATCH --exclusive\n"));
  EXPECT_THAT(script(),
              HasSubstr("\nset -- " + path("perform.yaml") + " -i " + path("in") + " -o " + path("out") +
                        " --set 'toy.perform.text=it'\\''s' --plugin " TOY_PLUGIN "\n"));
  const std::string merge = content("out/manifest/slurm/merge.sbatch");
  EXPECT_THAT(merge, HasSubstr("\nset -- " + path("out") + "\n"));
  EXPECT_THAT(merge, HasSubstr("\n#SBATCH --partition=long\n"));
}

/// The scripts are run as Slurm runs them: by bash, with its variables.
TEST_F(ClusterSubmitTest, ScriptsDoAllRecordingsAndWriteTheTable) {
  put("r4.pcap", "caveat");
  EXPECT_EQ(submit().status, 0);
  const std::string scripts = path("out/manifest/slurm/");
  const std::string tasks =
      "export SLURM_CPUS_ON_NODE=3 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_COUNT=6 SLURM_ARRAY_TASK_ID; for SLURM_ARRAY_TASK_ID in 1 2 3 4 5; do bash " +
      scripts + "batch.sbatch > /dev/null 2>&1; done";
  std::ignore = std::system(tasks.c_str());
  const auto first = content("out/manifest/shard-1-of-6/events.jsonl");
  EXPECT_EQ(nlohmann::json::parse(first.substr(0, first.find('\n')))["jobs"], 3);
  const std::string merge = "bash " + scripts + "merge.sbatch > " + path("merged");
  EXPECT_EQ(WEXITSTATUS(std::system(merge.c_str())), 1) << "a task is missing";
  EXPECT_THAT(content("merged"), HasSubstr(" not begun"));
  std::ignore = batch({"--shard", "6/6"});
  EXPECT_EQ(WEXITSTATUS(std::system(merge.c_str())), 3);
  EXPECT_THAT(content("merged"), HasSubstr("9 recordings: 8 done, 1 untrusted, 0 failed\n"));
  EXPECT_EQ(field("r4", "status"), "untrusted");
}

TEST_F(ClusterSubmitTest, DryRunPrintsTheScriptsAndSubmitsNothing) {
  const auto run = submit({"--dry-run"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("#SBATCH --array=1-6\n"));
  EXPECT_THAT(run.out, HasSubstr("batch table \"$1\""));
  EXPECT_THAT(run.out, EndsWith("sbatch --parsable --dependency=afterany:$job " +
                                path("out/manifest/slurm/merge.sbatch") + "\n"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_FALSE(fs::exists(folder_ / "submitted"));
}

TEST_F(ClusterSubmitTest, MakesAnArrayNoLongerThanTheSiteAllows) {
  install("scontrol", "echo 'MaxArraySize            = 5'");
  const auto run = submit();
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.error,
              HasSubstr("4 tasks instead of 6, each with more recordings: the site's MaxArraySize is 5\n"));
  EXPECT_THAT(script(), HasSubstr("--array=1-4\n"));
}

TEST_F(ClusterSubmitTest, MakesNoMoreTasksThanRecordings) {
  const auto run = submit({"--tasks", "20"});
  EXPECT_EQ(run.status, 2) << "--tasks twice";
  fs::remove(folder_ / "in/r0.pcap");
  for (int i = 1; i < 6; ++i) fs::remove(folder_ / "in" / ("r" + std::to_string(i) + ".pcap"));
  EXPECT_THAT(submit().error, HasSubstr("3 tasks instead of 6: there are no more recordings\n"));
}

TEST_F(ClusterSubmitTest, WaitsForTheMergeJobAndHasItsExitStatus) {
  install("sbatch", "echo 7\ncase \"$*\" in *--wait*) exit 3 ;; esac");
  EXPECT_EQ(submit().status, 0);
  EXPECT_EQ(submit({"--wait"}).status, 3);
}

TEST_F(ClusterSubmitTest, RefusesWhatNoTaskCouldDoBeforeAnythingIsSubmitted) {
  write_file(folder_ / "perform.yaml", "crisp: 1\npipeline:\n  - stage: toy.preform\n");
  const auto mistaken = submit();
  EXPECT_EQ(mistaken.status, 2);
  EXPECT_THAT(mistaken.error, HasSubstr("did you mean 'toy.perform'?"));
  const auto from_stdin =
      crisp({"cluster", "submit", path("perform.yaml"), "-i", "-", "-o", path("out"), "--tasks", "2"});
  EXPECT_EQ(from_stdin.status, 2);
  EXPECT_THAT(from_stdin.error, HasSubstr("tasks of a cluster cannot read the standard input"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_FALSE(fs::exists(folder_ / "submitted"));
}

TEST_F(ClusterSubmitTest, RefusesABatchWhoseTasksStillRun) {
  EXPECT_EQ(batch({"--shard", "2/6"}).status, 0);
  const FolderLock lock(folder_ / "out/manifest/shard-2-of-6");
  const auto run = submit();
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error,
              HasSubstr("shard-2-of-6 of this batch is running: process " + std::to_string(getpid())));
  EXPECT_FALSE(fs::exists(folder_ / "submitted"));
}

TEST_F(ClusterSubmitTest, NamesWhatSlurmDoesNotDo) {
  install("sbatch", "echo 'sbatch: error: no such partition' >&2\nexit 1");
  const auto refused = submit();
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.error, HasSubstr("no such partition"));
  EXPECT_THAT(refused.error, HasSubstr("sbatch refused " + path("out/manifest/slurm/batch.sbatch")));
  fs::remove_all(folder_ / "bin");
  setenv("PATH", path("bin").c_str(), 1);
  const auto missing = submit();
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(
      missing.error,
      HasSubstr("cannot run sbatch: No such file or directory; run the command where Slurm's programs"));
  EXPECT_THAT(missing.error, HasSubstr("scontrol did not report Slurm's MaxArraySize"));
}

}  // namespace
}  // namespace crisp
