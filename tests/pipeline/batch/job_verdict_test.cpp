// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/job_verdict.hpp"

#include <gmock/gmock.h>

#include <csignal>

#include <crisp/atomic_file.hpp>

#include "pipeline/files/folder_lock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
using namespace crisp::files;
using testing::HasSubstr;

class VerdictTest : public testing::Test {
 protected:
  DueRecording recording() const {
    return {.input = {.name = "r", .path = (folder_ / "r.pcap").string()}, .rig = {}};
  }
  JobVerdict judge(const JobEnd& end, const JobCircumstances& circumstances = {}) {
    return judge_job(end, circumstances, recording(), files_, folder_ / "out");
  }

  test::TemporaryFolder folder_;
  std::vector<InputFile> files_ = made();

 private:
  std::vector<InputFile> made() const {
    write_file(folder_ / "r.pcap", "content");
    return input_files(recording().input, {});
  }
};

TEST_F(VerdictTest, FollowsTheExitStatusOfARun) {
  EXPECT_EQ(judge({.exit_status = 0}).status, JobStatus::done);
  EXPECT_EQ(judge({.exit_status = 3}).status, JobStatus::untrusted);
  EXPECT_EQ(judge({.exit_status = 1, .error = "error: x\n"}).status, JobStatus::failed);
  EXPECT_EQ(judge({.exit_status = 1, .error = "error: x\n"}).failure, "error: x");
  EXPECT_THAT(judge({.exit_status = 1}).failure, HasSubstr("exited with status 1 and without a message"));
}

TEST_F(VerdictTest, DistinguishesACrashFromAKill) {
  EXPECT_EQ(judge({.signal = SIGSEGV}).status, JobStatus::failed);
  EXPECT_THAT(judge({.signal = SIGSEGV}).failure, HasSubstr("signal 11 (Segmentation fault)"));
  EXPECT_EQ(judge({.signal = SIGKILL}).status, JobStatus::interrupted);
  EXPECT_THAT(judge({.signal = SIGKILL}).failure, HasSubstr("--memory"));
  EXPECT_EQ(judge({.exit_status = 143}).status, JobStatus::interrupted) << "crisp run heard a SIGTERM";
}

TEST_F(VerdictTest, KnowsWhomTheBatchItselfEnded) {
  const auto late = judge({.signal = SIGKILL}, {.timeout = 7.5});
  EXPECT_EQ(late.status, JobStatus::failed);
  EXPECT_THAT(late.failure, HasSubstr("exceeded 7.5 s"));
  EXPECT_EQ(judge({.exit_status = 0}, {.timeout = 7.5}).status, JobStatus::done) << "it was just in time";
  EXPECT_EQ(judge({.exit_status = 143}, {.stopping = true}).status, JobStatus::interrupted);
  EXPECT_EQ(judge({.exit_status = 0}, {.stopping = true}).status, JobStatus::done);
}

TEST_F(VerdictTest, TakesAFullDiskForNoFaultOfTheRecording) {
  const auto full = judge({.exit_status = 1, .error = "error: cannot write x: No space left on device\n"});
  EXPECT_EQ(full.status, JobStatus::interrupted);
  EXPECT_THAT(full.full_disk, HasSubstr("No space left"));
}

TEST_F(VerdictTest, FindsAFullDiskAmongTheReasonsOfARunThatCameToItsEnd) {
  write_file(folder_ / "out/summary.json", R"({"inputs":[],"stages":[{"tag":"a","stage":"write.clouds",
    "outputs":[],"caveats":["no more clouds were written: No space left on device"],"report":{}}]})");
  const auto full = judge({.exit_status = 3});
  EXPECT_EQ(full.status, JobStatus::interrupted);
  EXPECT_THAT(full.full_disk, HasSubstr("No space left"));
}

TEST_F(VerdictTest, LeavesARecordingWhoseFolderIsInUseForLater) {
  const FolderLock lock(folder_ / "out");
  std::string refusal;
  try {
    const FolderLock second(folder_ / "out");
  } catch (const Error& error) {
    refusal = error.what();
  }
  EXPECT_EQ(judge({.exit_status = 2, .error = refusal}).status, JobStatus::interrupted);
  EXPECT_EQ(judge({.exit_status = 2, .error = "error: another\n"}).status, JobStatus::failed);
}

TEST_F(VerdictTest, DoesNotTrustAnInputThatChangedMeanwhile) {
  write_file(folder_ / "r.pcap", "other content");
  const auto changed = judge({.exit_status = 0});
  EXPECT_EQ(changed.status, JobStatus::interrupted);
  EXPECT_THAT(changed.failure, HasSubstr("it changed"));
}

TEST_F(VerdictTest, KeepsWhatTheSummaryHolds) {
  const std::string input = (folder_ / "r.pcap").string();
  write_file(folder_ / "out/summary.json",
             R"({"inputs":[{"file":")" + input + R"(","bytes":7,"sha256":"abc"}],
    "stages":[{"tag":"a","stage":"grabber.x","outputs":[],"caveats":["it is dark"],"report":{"first":5.5}},
              {"tag":"b","stage":"write.pcd","outputs":[],"caveats":[],"report":{"points":12}}]})");
  const auto event = judge({.exit_status = 3, .seconds = 1.5}).event;
  EXPECT_EQ(event["input"][0]["sha256"], "abc");
  EXPECT_EQ(event["seconds"], 1.5);
  EXPECT_EQ(event["results"]["reasons"][0], "a: it is dark");
  EXPECT_EQ(event["results"]["points"], 12);
  EXPECT_EQ(event["results"]["begin"], 5.5);
}

TEST_F(VerdictTest, ReportsUnreadableResults) {
  write_file(folder_ / "out/summary.json", "{");
  EXPECT_THAT(std::string(judge({.exit_status = 0}).event["results"]["reasons"][0]),
              HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace crisp
