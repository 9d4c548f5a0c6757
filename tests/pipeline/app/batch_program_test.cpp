// SPDX-License-Identifier: BSD-3-Clause
// `crisp batch` as people run it.
#include <gmock/gmock.h>

#include <filesystem>
#include <optional>
#include <random>

#include "pipeline/batch/shard.hpp"
#include "pipeline/files/folder_lock.hpp"
#include "tests/pipeline/app/batch_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
using namespace crisp::files;
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

TEST_F(BatchTest, ProcessesEachRecordingIntoAFolderOfItsName) {
  put("a.pcap", "done");
  put("site/b.pcap", "done");
  put("notes.md", "done");
  const auto run = batch();
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(content("out/a/a.txt"), "done\n");
  EXPECT_EQ(content("out/site/b/b.txt"), "done\n");
  EXPECT_EQ(json("out/site/b/summary.json")["threads"], 1);
  EXPECT_THAT(run.out, HasSubstr("2 done, 0 untrusted, 0 failed\n"));
  EXPECT_EQ(field("site/b", "status"), "done");
  EXPECT_EQ(json("out/batch.json")["counts"]["done"], 2);
  EXPECT_TRUE(std::filesystem::exists(path("out/report.html")));
}

TEST_F(BatchTest, GoesOnWithTheOthersWhereOneFailsOrIsUntrusted) {
  put("a.pcap", "done");
  put("b.pcap", "fail");
  put("c.pcap", "caveat");
  put("d.pcap", "abort");
  const auto run = batch();
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(field("a", "status"), "done");
  EXPECT_EQ(field("b", "status"), "failed");
  EXPECT_THAT(field("b", "reasons"),
              HasSubstr("toy.perform: the input requested a failure; use another input"));
  EXPECT_EQ(field("c", "status"), "untrusted");
  EXPECT_THAT(field("c", "reasons"), HasSubstr("the input requested a caveat"));
  EXPECT_EQ(field("d", "status"), "failed");
  EXPECT_THAT(field("d", "reasons"), HasSubstr("it was killed by signal 6 (Aborted)"));
  EXPECT_THAT(run.error, HasSubstr("b: " + path("perform.yaml")));
}

TEST_F(BatchTest, EndsWithThreeWhereARecordingCannotBeTrusted) {
  put("a.pcap", "done");
  put("b.pcap", "caveat");
  EXPECT_EQ(batch().status, 3);
  EXPECT_EQ(batch().status, 3) << "though nothing is done again";
}

TEST_F(BatchTest, DoesNothingTwiceThatIsUnchanged) {
  put("a.pcap", "done");
  put("b.pcap", "fail");
  EXPECT_EQ(batch().status, 1);
  const auto again = batch();
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(calls(), ElementsAre(Pair("a.pcap", 1), Pair("b.pcap", 1)));
  EXPECT_THAT(again.error, HasSubstr("2 recordings already done and unchanged\n  1 of them failed"));
}

TEST_F(BatchTest, ProcessesAChangedInputAgainAndReportsIt) {
  put("a.pcap", "done");
  put("b.pcap", "done");
  EXPECT_EQ(batch().status, 0);
  put("b.pcap", "caveat");
  const auto again = batch();
  EXPECT_EQ(again.status, 3);
  EXPECT_THAT(again.error, HasSubstr("due again, since the input changed: 1 recording (b)\n"));
  EXPECT_THAT(calls(), ElementsAre(Pair("a.pcap", 1), Pair("b.pcap", 2)));
  EXPECT_EQ(content("out/b/b.txt"), "caveat\n");
}

TEST_F(BatchTest, DistinguishesATouchedInputFromAChangedOneByItsContent) {
  put("a.pcap", "done");
  EXPECT_EQ(batch().status, 0);
  const auto later = fs::last_write_time(folder_ / "in/a.pcap") + std::chrono::hours(1);
  fs::last_write_time(folder_ / "in/a.pcap", later);
  EXPECT_EQ(batch().status, 0);
  EXPECT_THAT(calls(), ElementsAre(Pair("a.pcap", 1)));
  EXPECT_THAT(content("out/manifest/batch/events.jsonl"), HasSubstr("{\"event\":\"same\""));
  put("a.pcap", "wine");  // as long as before
  fs::last_write_time(folder_ / "in/a.pcap", later + std::chrono::hours(1));
  EXPECT_EQ(batch().status, 0);
  EXPECT_EQ(content("out/a/a.txt"), "wine\n");
}

TEST_F(BatchTest, ProcessesAllAgainWithOtherSettingsAndNamesWhatChanged) {
  put("a.pcap", "done");
  EXPECT_EQ(batch().status, 0);
  const auto other = batch({"--set", "toy.perform.text=!"});
  EXPECT_EQ(other.status, 0);
  EXPECT_THAT(
      other.error,
      HasSubstr(
          "due again, since the settings changed: 1 recording (a)\n  toy.perform.text: \"\" → \"!\"\n"));
  EXPECT_EQ(content("out/a/a.txt"), "done!\n");
}

TEST_F(BatchTest, RefusesInputsThatWouldShareAnOutputBeforeAnythingRuns) {
  put("a.pcap", "done");
  put("a.pcapng", "done");
  put("b.pcap", "done");
  const auto run = batch();
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error, HasSubstr("would share the output a; "));
  EXPECT_TRUE(calls().empty());
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(BatchTest, RefusesAPipelineThatDoesNotDependOnTheRecording) {
  put("a.pcap", "done");
  write_file(
      folder_ / "perform.yaml",
      "crisp: 1\npipeline:\n  - stage: toy.perform\n    with: {file: /x, result: " + path("r.txt") + "}\n");
  const auto run = batch();
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(
      run.error,
      HasSubstr("perform.yaml:4:30: error: toy.perform: each recording would overwrite \"" + path("r.txt")));
  EXPECT_THAT(run.error, HasSubstr("every job would be the same; let it read ${input}"));
}

TEST_F(BatchTest, ReportsEveryMistakeOfThePipelineOnce) {
  put("a.pcap", "done");
  write_file(folder_ / "perform.yaml", "crisp: 1\npipeline:\n  - stage: toy.preform\n");
  const auto run = batch();
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error, HasSubstr("did you mean 'toy.perform'?"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(BatchTest, EndsEachJobThatTakesTooLong) {
  put("a.pcap", "wait");
  put("b.pcap", "wait");
  EXPECT_EQ(batch({"--timeout", "200ms"}).status, 1);
  for (const std::string recording : {"a", "b"}) {
    EXPECT_EQ(field(recording, "status"), "failed");
    EXPECT_THAT(field(recording, "reasons"), HasSubstr("it exceeded 0.2 s"));
    put(recording + ".pcap", "done");
  }
  EXPECT_EQ(batch({"--timeout", "10min"}).status, 0);
  EXPECT_EQ(field("b", "status"), "done") << "in time";
}

TEST_F(BatchTest, StopsInGoodOrderOnASignalAndGoesOnLater) {
  put("a.pcap", "wait");
  put("b.pcap", "done");
  const pid_t child = start(words({"--jobs", "1"}));
  wait_for_calls(1);
  kill(child, SIGINT);
  const auto stopped = wait_for(child);
  EXPECT_EQ(stopped.status, 130);
  EXPECT_THAT(stopped.error,
              HasSubstr("interrupted: 0 of 2 recordings ended; run the batch again to continue\n"));
  put("a.pcap", "done");
  EXPECT_EQ(batch().status, 0);
  EXPECT_THAT(calls(), ElementsAre(Pair("a.pcap", 2), Pair("b.pcap", 1)));
}

/// A job may hold its process for good; the batch must not.
TEST_F(BatchTest, LeavesNoJobBehindHoweverItEnds) {
  put("a.pcap", "hang");
  for (const int signal : {SIGKILL, SIGINT}) {
    const pid_t child = start(words());
    while (calls()["a.pcap"] < (signal == SIGKILL ? 1 : 2)) std::this_thread::yield();
    kill(child, signal);
    while (signal == SIGINT && content("stderr").find("stopping") == std::string::npos)
      std::this_thread::yield();
    if (signal == SIGINT) kill(child, signal);
    EXPECT_EQ(wait_for(child).status, -signal);
    while (FolderLock::holder_of(folder_ / "out/a")) std::this_thread::yield();  // until the job is dead
  }
}

TEST_F(BatchTest, ProcessesAgainWhatWasKilledFromOutside) {
  put("a.pcap", "hang");
  const pid_t child = start(words());
  wait_for_calls(1);
  while (!FolderLock::holder_of(folder_ / "out/a")) std::this_thread::yield();
  const std::string holder = *FolderLock::holder_of(folder_ / "out/a");
  kill(std::stoi(holder.substr(std::string("process ").size())), SIGKILL);
  EXPECT_EQ(wait_for(child).status, 1);
  EXPECT_EQ(field("a", "status"), "interrupted");
  EXPECT_THAT(field("a", "reasons"), HasSubstr("killed by signal 9 (Killed)"));
  put("a.pcap", "done");
  const auto again = batch();
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.error,
              HasSubstr("due again, since they were stopped or killed from outside: 1 recording (a)\n"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out/a"), {}), 3) << "result, provenance, summary";
}

TEST_F(BatchTest, StopsWhenTheDiskIsFullAndGoesOnLater) {
  put("a.pcap", "done");
  put("b.pcap", "full");
  put("c.pcap", "done");
  const auto run = batch({"--jobs", "1"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("the disk is full, so the batch stopped: "));
  EXPECT_THAT(calls(), ElementsAre(Pair("a.pcap", 1), Pair("b.pcap", 1)));
  put("b.pcap", "done");
  EXPECT_EQ(batch().status, 0);
  EXPECT_THAT(calls(), ElementsAre(Pair("a.pcap", 1), Pair("b.pcap", 2), Pair("c.pcap", 1)));
}

TEST_F(BatchTest, RefusesAFolderThatAnotherBatchWritesInto) {
  put("a.pcap", "done");
  const FolderLock lock(folder_ / "out/manifest/batch");
  const auto second = batch();
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.error, HasSubstr("manifest/batch is in use: process " + std::to_string(getpid())));
  EXPECT_TRUE(calls().empty());
}

TEST_F(BatchTest, LeavesARecordingThatAnotherRunIsWriting) {
  put("a.pcap", "done");
  fs::create_directories(folder_ / "out/a");
  {
    const FolderLock lock(folder_ / "out/a");
    EXPECT_EQ(batch().status, 1);
    EXPECT_EQ(field("a", "status"), "interrupted");
    EXPECT_THAT(field("a", "reasons"), HasSubstr("is in use: process " + std::to_string(getpid())));
  }
  EXPECT_EQ(batch().status, 0);
}

TEST_F(BatchTest, TakesEachFolderAsOneRecording) {
  write_file(folder_ / "perform.yaml",
             "crisp: 1\npipeline:\n  - stage: toy.perform\n"
             "    with: {file: \"${input}/1.pcap\", result: \"${output}/${stem}-${name}.txt\"}\n");
  put("x/1.pcap", "done");
  put("x/2.pcap", "done");
  put("y/1.pcap", "done");
  const auto run = batch({"--each", "folder"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(content("out/x/x-x.txt"), "done\n");
  EXPECT_EQ(content("out/y/y-y.txt"), "done\n");
  put("x/2.pcap", "changed");
  EXPECT_THAT(batch({"--each", "folder"}).error, HasSubstr("the input changed: 1 recording (x)\n"));
}

TEST_F(BatchTest, UsesARigPerRecording) {
  const std::string rig = "crisp: 1\nlasers:\n  one: {nominal: {lambda: 0deg, tau: 20cm}}\nplate: {}\n";
  put("x/1.pcap", "done");
  put("x/rig.yaml", rig);
  put("y/1.pcap", "done");
  const std::vector<std::string> with_rig = {"--rig", "{folder}/rig.yaml"};
  const auto run = batch(with_rig);
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(json("out/x/1/summary.json")["rig"], path("in/x/rig.yaml"));
  EXPECT_EQ(field("y/1", "status"), "failed");
  EXPECT_THAT(field("y/1", "reasons"), HasSubstr(path("in/y/rig.yaml")));
  put("y/rig.yaml", rig);
  EXPECT_EQ(batch(with_rig).status, 0);
  EXPECT_EQ(calls()["1.pcap"], 2) << "that of x is not done again";
}

TEST_F(BatchTest, DividesTheRecordingsAmongShards) {
  for (int i = 0; i < 20; ++i) put("r" + std::to_string(i) + ".pcap", "done");
  for (const char* shard : {"1/3", "2/3", "3/3"}) EXPECT_EQ(batch({"--shard", shard}).status, 0);
  const auto called = calls();
  EXPECT_EQ(called.size(), 20U);
  for (const auto& [name, count] : called) EXPECT_EQ(count, 1) << name;
  const auto whole = batch();
  EXPECT_THAT(whole.error, HasSubstr("20 recordings already done and unchanged"));
  EXPECT_THAT(calls(), called) << "what shards did counts for all";
}

/// A scheduler may start a task again that lives on.
TEST_F(BatchTest, WaitsForAPartThatAnotherProcessHas) {
  put("a.pcap", "done");
  std::optional<FolderLock> lock(std::in_place, folder_ / "out/manifest/shard-1-of-1000");
  const Shard shard{1, 1000};
  int number = 0;
  while (!shard.has("r" + std::to_string(number))) ++number;
  put("r" + std::to_string(number) + ".pcap", "done");
  const pid_t child = start(words({"--shard", "1/1000"}));
  while (content("stderr").find("waiting for part 1/1000: ") == std::string::npos) std::this_thread::yield();
  EXPECT_TRUE(calls().empty());
  lock.reset();
  EXPECT_EQ(wait_for(child).status, 0);
  EXPECT_EQ(calls().size(), 1U);
}

TEST_F(BatchTest, DoesNotWaitForAPartWhoseFolderCannotBeMade) {
  put("a.pcap", "done");
  fs::create_directory(folder_ / "out");
  write_file(folder_ / "out/manifest", "no folder");
  EXPECT_EQ(batch({"--shard", "1/2"}).status, 2);
}

/// The processes that a process started.
std::vector<pid_t> children_of(pid_t process) {
  const std::string number = std::to_string(process);
  std::ifstream list("/proc/" + number + "/task/" + number + "/children");
  std::vector<pid_t> children;
  for (pid_t child = 0; list >> child;) children.push_back(child);
  return children;
}

/// Batches that are killed, and go on.
class KilledBatchTest : public BatchTest {
 protected:
  /// Each round has new recordings, and ends with the batch dead; in every other one a job was killed before.
  void run_rounds(int rounds) {
    constexpr int kNewInARound = 4;
    std::mt19937 random(1);
    std::uniform_int_distribution<int> milliseconds(0, 60);
    const auto pause = [&] { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds(random))); };
    for (int round = 0; round < rounds; ++round) {
      for (int i = 0; i < kNewInARound; ++i) put("r" + std::to_string(recordings_++) + ".pcap", "done");
      const pid_t child = start(words({"--jobs", "2"}));
      pause();
      if (round % 2 == 1) {
        for (const pid_t launcher : children_of(child)) {
          for (const pid_t job : children_of(launcher)) kill(job, SIGKILL);
        }
        pause();
      }
      kill(child, SIGKILL);
      wait_for(child);
    }
  }

  void expect_each_done_once() const {
    std::map<std::string, int> done;
    std::istringstream events(content("out/manifest/batch/events.jsonl"));
    for (std::string line; std::getline(events, line);) {
      const auto event = nlohmann::json::parse(line);
      if (event["event"] == "end" && event["status"] == "done") ++done[event["name"]];
    }
    EXPECT_EQ(done.size(), recordings_);
    for (const auto& [name, times] : done) {
      EXPECT_EQ(times, 1) << name;
      const fs::path output = fs::path("out") / name;
      EXPECT_EQ(content((output / name).string() + ".txt"), "done\n");
      EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / output), {}), 3) << "nothing is left of kills";
    }
  }

  std::size_t recordings_ = 0;
};

TEST_F(KilledBatchTest, DoesEachRecordingOnceWhateverIsKilledInWhichMoment) {
  run_rounds(20);
  EXPECT_EQ(batch().status, 0);
  expect_each_done_once();
}

TEST_F(KilledBatchTest, DoesEachRecordingOnceThroughAHundredRounds) {
  run_rounds(100);
  EXPECT_EQ(batch().status, 0);
  expect_each_done_once();
}

}  // namespace
}  // namespace crisp
