// SPDX-License-Identifier: BSD-3-Clause
// The program as people run it, with toy stages from a plugin.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iterator>
#include <set>
#include <thread>

#include "tests/pipeline/app/program_fixture.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

TEST_F(ProgramTest, RunsAPipelineAndWritesItsResultSummaryAndProvenance) {
  const auto run = crisp({"run", path("sum.yaml"), "-o", path("out"), "--seed", "7"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(content("out/sum.txt"), "10\n");
  EXPECT_THAT(run.out, HasSubstr("the sum is 10"));
  EXPECT_THAT(run.out, HasSubstr("warning: it is only a toy"));
  EXPECT_THAT(run.out, HasSubstr("1  sums\n"));
  EXPECT_THAT(run.out, Not(HasSubstr("sums that were lost")));
  EXPECT_THAT(run.out, HasSubstr("wrote " + path("out/sum.txt")));

  const auto summary = json("out/summary.json");
  EXPECT_EQ(summary["trusted"], true);
  EXPECT_EQ(summary["exit_status"], 0);
  EXPECT_FALSE(summary.contains("error"));
  EXPECT_EQ(summary["seed"], 7);
  EXPECT_EQ(summary["stages"][0]["options"]["n"], 4);
  EXPECT_EQ(summary["stages"][0]["options"]["first"], 1);
  EXPECT_EQ(summary["stages"][0]["given"]["Number"], 4);
  EXPECT_EQ(summary["stages"][2]["report"]["sum"], 10);
  EXPECT_EQ(summary["stages"][2]["counts"]["sums that were lost"], 0);

  const auto provenance = json("out/sum.txt.provenance.json");
  EXPECT_EQ(provenance["file"], "sum.txt");
  EXPECT_EQ(provenance["stages"][0]["options"]["n"], 4);
  EXPECT_EQ(provenance["inputs"][0]["file"], path("sum.yaml"));
  EXPECT_EQ(provenance["inputs"][0]["bytes"], fs::file_size(folder_ / "sum.yaml"));
}

TEST_F(ProgramTest, FindsInstalledPipelinesByName) {
  const auto found = crisp({"validate", "calibrate"});
  EXPECT_EQ(found.status, 0) << found.error;
  EXPECT_THAT(found.out, HasSubstr("configs/calibrate.yaml: valid"));
  const auto unknown = crisp({"run", "calibrat"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_EQ(
      unknown.error,
      "error: pipeline: there is no file calibrat, and no installed pipeline of that name; did you mean 'calibrate'?; see crisp run --help\n");
  EXPECT_THAT(crisp({"run", "xyz"}).error, HasSubstr("give a YAML file, or one of assemble, basin, bound,"));
}

TEST_F(ProgramTest, CalibratesByAShortForm) {
  ASSERT_EQ(crisp({"run", "simulate", "-o", path("made"), "--set", "grabber.simulate.duration=4s"}).status,
            0);
  const auto brief = crisp({"calibrate", path("made/hub.pcap"), "-o", path("brief")});
  const auto full = crisp({"run", "calibrate", "-i", path("made/hub.pcap"), "-o", path("full")});
  EXPECT_EQ(brief.status, full.status) << brief.error;
  EXPECT_EQ(content("brief/cloud.pcd"), content("full/cloud.pcd"));
  EXPECT_GT(content("brief/cloud.pcd").size(), 100000U);
  EXPECT_EQ(crisp({"diagnose", path("no.pcap")}).error,
            "error: there is no input " + path("no.pcap") + "; check the name after -i\n");
}

TEST_F(ProgramTest, LetsSettingsGoBeforeTheFileAndFlagsThatAreNotGivenNot) {
  const auto run =
      crisp({"run", path("sum.yaml"), "-o", path("out"), "--set", "toy.count.first=10", "--quiet"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(content("out/sum.txt"), "46\n");
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.error, "warning: toy.write: it is only a toy\n");
}

TEST_F(ProgramTest, EndsWithThreeWhenTheResultCannotBeTrusted) {
  const auto run = crisp({"run", path("sum.yaml"), "-o", path("out"), "--set", "toy.write.caveat=true"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.out, HasSubstr("UNTRUSTED: the sum was with_caveats"));
  EXPECT_EQ(json("out/summary.json")["trusted"], false);
}

TEST_F(ProgramTest, ValidatesWithoutOpeningInputOrOutput) {
  const auto outcome = crisp({"validate", path("sum.yaml")});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.out, path("sum.yaml") + ": valid, 3 stages\n");
}

TEST_F(ProgramTest, ValidatesARig) {
  write_file(folder_ / "rig.yaml",
             "crisp: 1\nlasers:\n  one: {nominal: {lambda: 0deg, tau: 20cm}}\nplate: {}\n");
  const auto right = crisp({"validate", path("rig.yaml")});
  EXPECT_EQ(right.status, 0) << right.error;
  EXPECT_EQ(right.out, path("rig.yaml") + ": valid, a rig of 1 laser\n");
  EXPECT_EQ(crisp({"validate", path("rig.yaml"), "--rig", path("rig.yaml")}).error,
            "error: " + path("rig.yaml") + " is a rig; --rig and --set are for pipelines\n");
  write_file(folder_ / "rig.yaml",
             "crisp: 1\nlasers:\n  one: {tau: 20cm, nominal: {lambda: 0, tua: 20cm}}\nplate: {}\n");
  const auto wrong = crisp({"validate", path("rig.yaml")});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.error, HasSubstr(path("rig.yaml") + ":3:9: error: "));
  EXPECT_THAT(wrong.error, HasSubstr("did you mean 'tau'?"));
  EXPECT_THAT(wrong.error, testing::EndsWith("3 errors\n"));
}

TEST_F(ProgramTest, NamesTheKindOfAFileInTheWrongPlace) {
  write_file(folder_ / "rig.yaml",
             "crisp: 1\nlasers:\n  one: {nominal: {lambda: 0deg, tau: 20cm}}\nplate: {}\n");
  const auto rig = crisp({"run", path("rig.yaml"), "-o", path("out")});
  EXPECT_EQ(rig.status, 2);
  EXPECT_EQ(rig.error,
            "error: " + path("rig.yaml") +
                " is a rig, not a pipeline; give it with --rig; configs/calibrate.yaml is a pipeline\n");
  EXPECT_EQ(crisp({"run", path("sum.yaml"), "-o", path("out"), "--rig", path("sum.yaml")}).error,
            "error: " + path("sum.yaml") + " is a pipeline, not a rig; configs/rig.yaml is a rig\n");
}

TEST_F(ProgramTest, WarnsOfAStageThatWasPutTooLow) {
  write_file(folder_ / "low.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.sum}\n  - {stage: toy.throw}\n");
  const auto outcome = crisp({"validate", path("low.yaml")});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(
      outcome.error,
      path("low.yaml") +
          ":5:13: warning: toy.throw: no stage below takes the items of toy.throw; move it above toy.sum, which does\n");
  EXPECT_THAT(crisp({"run", path("low.yaml")}).error, HasSubstr(":5:13: warning: toy.throw: no stage below"));
}

TEST_F(ProgramTest, EndsWithOneWhenAStageFailsAndWritesNothing) {
  write_file(folder_ / "fail.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.throw}\n  - {stage: toy.sum}\n"
             "  - {stage: toy.write, with: {file: ${output}/sum.txt}}\n");
  const auto run = crisp({"run", path("fail.yaml"), "-o", path("out")});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.error, path("fail.yaml") + ":4:13: error: toy.throw: it saw a three; avoid threes\n");
  EXPECT_FALSE(fs::exists(folder_ / "out/sum.txt"));
  const auto summary = json("out/summary.json");
  EXPECT_EQ(summary["trusted"], false);
  EXPECT_EQ(summary["exit_status"], 1);
  EXPECT_EQ(summary["error"], path("fail.yaml") + ":4:13: error: toy.throw: it saw a three; avoid threes");
}

TEST_F(ProgramTest, NamesWhoThrewWhatIsNoException) {
  write_file(folder_ / "fail.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.throw, with: {how: integer}}\n"
             "  - {stage: toy.sum}\n");
  const auto run = crisp({"run", path("fail.yaml"), "-o", path("out")});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(
      run.error,
      path("fail.yaml") +
          ":4:13: error: toy.throw: it threw something that is no std::exception; let it throw crisp::Error\n");
  const auto load = crisp({"stages", "--plugin", THROWING_PLUGIN});
  EXPECT_EQ(load.status, 2);
  EXPECT_THAT(load.error, HasSubstr("throwing_plugin.so was refused: its registration threw"));
}

TEST_F(ProgramTest, RecordsWhereFilesOfAFailedRunCameFrom) {
  write_file(folder_ / "late.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.sum}\n"
             "  - {stage: toy.write, with: {file: ${output}/sum.txt}}\n  - {stage: toy.end_badly}\n");
  EXPECT_EQ(crisp({"run", path("sum.yaml"), "-o", path("out")}).status, 0);
  const auto run = crisp({"run", path("late.yaml"), "-o", path("out")});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(content("out/sum.txt"), "6\n");
  const auto provenance = json("out/sum.txt.provenance.json");
  EXPECT_EQ(provenance["inputs"][0]["file"], path("late.yaml"));
  EXPECT_EQ(provenance["failure"], path("late.yaml") + ":6:13: error: toy.end_badly: the end is bad");
  EXPECT_EQ(provenance["trusted"], false);
  EXPECT_EQ(json("out/summary.json")["error"], provenance["failure"]) << "not the earlier run's";
}

TEST_F(ProgramTest, RemovesWhatIsNotCompleteBeforeItWritesItsRecords) {
  write_file(folder_ / "full.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.sum}\n"
             "  - {stage: toy.in_the_way, with: {folder: \"${output}\", name: summary.json}}\n");
  const auto run = crisp({"run", path("full.yaml"), "-o", path("out")});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.error, path("full.yaml") + ":5:13: error: toy.in_the_way: there is no room\n");
  EXPECT_EQ(json("out/summary.json")["trusted"], false);
}

TEST_F(ProgramTest, WritesEachRecordThoughAnotherCannotBeWritten) {
  write_file(
      folder_ / "two.yaml",
      "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.sum}\n"
      "  - {stage: toy.write, with: {file: ${output}/a}}\n"
      "  - {stage: toy.write, with: {file: ${output}/b}}\n"
      "  - {stage: toy.write, with: {file: ${output}/c}}\n"
      "  - {stage: toy.in_the_way, with: {folder: \"${output}\", name: a.provenance.json, stays: true}}\n"
      "  - {stage: toy.in_the_way, with: {folder: \"${output}\", name: b.provenance.json, stays: true}}\n");
  const auto run = crisp({"run", path("two.yaml"), "-o", path("out")});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("cannot write " + path("out/a.provenance.json")));
  EXPECT_THAT(run.error, HasSubstr("cannot write " + path("out/b.provenance.json")));
  EXPECT_TRUE(fs::is_regular_file(folder_ / "out/c.provenance.json"));
  const auto summary = json("out/summary.json");
  EXPECT_EQ(summary["stages"][4]["outputs"][0], path("out/c"));
  EXPECT_EQ(summary["exit_status"], 1);
  EXPECT_THAT(std::string(summary["error"]), HasSubstr("a.provenance.json"));
}

TEST_F(ProgramTest, ReportsWhenItsOutputDoesNotArrive) {
  for (const auto& command :
       std::vector<std::string>{"stages", "--help", "run " + path("sum.yaml") + " -o " + path("out")}) {
    const std::string line = CRISP_PROGRAM " " + command +
                             (command == "--help" ? "" : " --plugin " TOY_PLUGIN) + " >/dev/full 2>" +
                             path("stderr");
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 1) << command;
    EXPECT_THAT(content("stderr"), HasSubstr("error: cannot write to the standard output"));
  }
}

TEST_F(ProgramTest, RunsToItsEndThoughNobodyReadsItsOutput) {
  for (const auto& [caveat, status] : {std::pair{"false", 0}, std::pair{"true", 3}}) {
    const std::string line = CRISP_PROGRAM " run " + path("sum.yaml") + " -o " + path("out") +
                             " --plugin " TOY_PLUGIN " --set toy.write.caveat=" + caveat;
    // The reader is gone before the first word.
    const std::string piped =
        "bash -c '(sleep 0.2; " + line + " 2>&1; echo $? >" + path("status") + ") | true'";
    EXPECT_EQ(std::system(piped.c_str()), 0);
    EXPECT_EQ(content("status"), std::to_string(status) + "\n");
    EXPECT_EQ(content("out/sum.txt"), "10\n");
    EXPECT_EQ(json("out/sum.txt.provenance.json")["trusted"], status == 0);
    EXPECT_EQ(json("out/summary.json")["exit_status"], status);
    fs::remove_all(folder_ / "out");
  }
}

TEST_F(ProgramTest, RefusesWhatCannotBeRun) {
  EXPECT_THAT(crisp({"run", path("sum.yaml")}).error, HasSubstr("${output} has no value; give it with -o"));
  EXPECT_THAT(crisp({"run", path("sum.yaml"), "-o", path("sum.yaml")}).error,
              HasSubstr("cannot write into the folder " + path("sum.yaml")));
  EXPECT_THAT(crisp({"run", path("sum.yaml"), "-o", path("out"), "-i", path("nowhere")}).error,
              HasSubstr("there is no input " + path("nowhere")));
  write_file(folder_ / "cut_0001.pcd", "");
  EXPECT_EQ(crisp({"run", path("sum.yaml"), "-o", path("out"), "-i", path("cut.pcd")}).status, 0);
  EXPECT_EQ(crisp({"run", path("nowhere.yaml")}).status, 2);
  EXPECT_EQ(crisp({"run", path("sum.yaml"), "--threads", "0"}).status, 2);
  const auto unknown = crisp({"rnu"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_EQ(unknown.error, "error: there is no command 'rnu'; did you mean 'run'?\n");
  EXPECT_THAT(crisp({"study", "bond"}).error,
              HasSubstr("there is no command 'study bond'; did you mean 'bound'?"));
  EXPECT_THAT(crisp({"basn"}).error, HasSubstr("did you mean 'basin'?"));
  EXPECT_THAT(crisp({"bound", "--durration", "3s"}).error,
              HasSubstr("did you mean '--duration'?; see crisp study bound --help"));
  EXPECT_THAT(crisp({"monte-carlo", "-n", "four"}).error,
              HasSubstr("'four' is not a whole number, 1 to 1000000"));
  EXPECT_THAT(crisp({"monte-carlo", "-n", "0"}).error, HasSubstr("0 is not from 1 to 1000000"));
  const auto negative = crisp({"run", path("sum.yaml"), "-o", path("out"), "--seed", "-1"});
  EXPECT_EQ(negative.status, 2);
  EXPECT_THAT(negative.error, HasSubstr("error: --seed: '-1' is not a whole number"));
  EXPECT_THAT(crisp({"run"}).error, testing::StartsWith("error: pipeline is required"));
  const auto listen = crisp({"record", "-o", path("out"), "--listen", "here", "--duration", "1s"});
  EXPECT_EQ(listen.status, 2);
  EXPECT_THAT(listen.error, HasSubstr("\"here\" is no IP address"));
}

TEST_F(ProgramTest, RefusesOptionsThatAreEmpty) {
  for (const char* option : {"--input", "--output", "--rig", "--set"}) {
    const auto outcome = crisp({"run", path("sum.yaml"), option, ""});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.error, HasSubstr("error: " + std::string(option) + " is empty"));
  }
  const auto outcome = crisp({"run", path("sum.yaml"), "-i", "", "-o", path("out")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.error, HasSubstr("error: --input is empty"));
  EXPECT_THAT(crisp({"info", ""}).error, HasSubstr("error: file is empty"));
}

TEST_F(ProgramTest, RecordsForTheRequestedDurationWithoutDevices) {
  write_file(folder_ / "rig.yaml",
             "crisp: 1\nlasers: {a: {address: 127.0.0.1, port: 9, nominal: {lambda: 0, tau: 0.2}}}\n"
             "plate: {address: 127.0.0.1, port: 47311}\n");
  const auto outcome = crisp({"record", "--rig", path("rig.yaml"), "-o", path("out"), "--duration", "0.2s"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.error, HasSubstr("nothing was received"));
}

/// The stage is at work, with a half-written file, once that file is there.
TEST_F(ProgramTest, StopsInGoodOrderOnSignals) {
  write_file(folder_ / "wait.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.wait, with: {file: ${output}/x.txt}}\n");
  for (const auto& [signal, status] :
       {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}, std::pair{SIGHUP, 129}}) {
    const pid_t child = start({"run", path("wait.yaml"), "-o", path("out")});
    wait_for_part();
    kill(child, signal);
    const auto outcome = wait_for(child);
    EXPECT_EQ(outcome.status, status);
    EXPECT_THAT(outcome.error, HasSubstr("stopping; a second signal ends the program at once\n"));
    EXPECT_THAT(outcome.error, HasSubstr("interrupted: incomplete files were not written\n"));
    EXPECT_FALSE(fs::exists(folder_ / "out/x.txt"));
    EXPECT_EQ(json("out/summary.json")["error"], "interrupted");
    EXPECT_EQ(json("out/summary.json")["exit_status"], status);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out"), {}), 1);
    fs::remove_all(folder_ / "out");
  }
}

TEST_F(ProgramTest, IsInterruptedWhileItReadsAPipeIntoWhichNobodyWrites) {
  mkfifo((folder_ / "pipe").c_str(), 0600);
  const std::vector<std::string> grabbers = {
      "grabber.capture, with: {file: pipe}", "grabber.telegrams, with: {file: pipe}",
      "grabber.table, with: {file: pipe, time_column: 1, angle_column: 2, range_column: 3, laser_column: 4, angle_step: 1deg}"};
  for (const auto& grabber : grabbers) {
    write_file(folder_ / "pipe.yaml",
               fmt::format("crisp: 1\npipeline:\n  - {{stage: {0}}}\n  - {{stage: {0}}}\n", grabber));
    const pid_t child = start({"run", path("pipe.yaml"), "-o", path("out"), "--threads", "2"});
    wait_for_handler(child, SIGTERM);
    kill(child, SIGTERM);
    EXPECT_EQ(wait_for(child).status, 143) << grabber << content("stderr");
  }
}

TEST_F(ProgramTest, LeavesNoPartsOfFilesWhenItIsEndedAtOnce) {
  write_file(folder_ / "hang.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.hang, with: {file: ${output}/x.txt}}\n");
  for (const int second : {SIGINT, SIGTERM}) {
    const pid_t child = start({"run", path("hang.yaml"), "-o", path("out")});
    wait_for_part();
    kill(child, SIGINT);
    while (content("stderr").find("stopping") == std::string::npos) std::this_thread::yield();
    kill(child, second);
    EXPECT_EQ(wait_for(child).status, -second);
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
    fs::remove(folder_ / "out");
  }
}

TEST_F(ProgramTest, RemovesThePartsThatARunWhichWasKilledLeft) {
  write_file(folder_ / "wait.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.wait, with: {file: ${output}/x.txt}}\n");
  const pid_t killed = start({"run", path("wait.yaml"), "-o", path("out")});
  wait_for_part();
  kill(killed, SIGKILL);
  wait_for(killed);
  write_file(folder_ / "out/.mine.part", "of another program");
  EXPECT_EQ(crisp({"run", path("sum.yaml"), "-o", path("out")}).status, 0);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) names.insert(entry.path().filename());
  EXPECT_THAT(names,
              testing::ElementsAre(".mine.part", "sum.txt", "sum.txt.provenance.json", "summary.json"));
}

TEST_F(ProgramTest, IsInterruptedWhateverAStageComplainsOfThen) {
  write_file(folder_ / "complain.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.complain, with: {file: " + path("waits") + "}}\n");
  const pid_t child = start({"run", path("complain.yaml")});
  while (!fs::exists(folder_ / "waits")) std::this_thread::yield();
  kill(child, SIGINT);
  const auto outcome = wait_for(child);
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.error, Not(HasSubstr("half of the work")));
}

}  // namespace
}  // namespace crisp
