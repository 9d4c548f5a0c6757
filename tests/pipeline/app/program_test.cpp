// SPDX-License-Identifier: BSD-3-Clause
// The program as people run it, with toy stages from a plugin.
#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "tests/pipeline/app/program_fixture.hpp"
#include "tests/support/source_dir.hpp"

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

TEST_F(ProgramTest, LetsSettingsGoBeforeTheFileAndFlagsThatAreNotGivenNot) {
  const auto run =
      crisp({"run", path("sum.yaml"), "-o", path("out"), "--set", "toy.count.first=10", "--quiet"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(content("out/sum.txt"), "46\n");
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.error, "warning: toy.write: it is only a toy\n");
}

TEST_F(ProgramTest, EndsWithThreeWhenTheResultCannotBeTrusted) {
  const auto run = crisp({"run", path("sum.yaml"), "-o", path("out"), "--set", "toy.write.doubt=true"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.out, HasSubstr("NOT TO BE TRUSTED: the sum was doubted"));
  EXPECT_EQ(json("out/summary.json")["trusted"], false);
}

TEST_F(ProgramTest, ValidatesWithoutOpeningInputOrOutput) {
  const auto outcome = crisp({"validate", path("sum.yaml")});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.out, path("sum.yaml") + ": right, 3 stages\n");
}

TEST_F(ProgramTest, WarnsOfAStageThatWasPutTooLow) {
  write_file(folder_ / "low.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.sum}\n  - {stage: toy.throw}\n");
  const auto outcome = crisp({"validate", path("low.yaml")});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.error, path("low.yaml") +
                               ":5:13: warning: toy.throw: nothing below takes what toy.throw gives; put it "
                               "above toy.sum, which could\n");
  EXPECT_THAT(crisp({"run", path("low.yaml")}).error, HasSubstr(":5:13: warning: toy.throw: nothing below"));
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
  EXPECT_EQ(run.error, path("fail.yaml") +
                           ":4:13: error: toy.throw: it threw what is no std::exception; let "
                           "it throw crisp::Error\n");
  const auto load = crisp({"stages", "--plugin", THROWING_PLUGIN});
  EXPECT_EQ(load.status, 2);
  EXPECT_THAT(load.error, HasSubstr("throwing_plugin.so was refused: registering its stages it threw"));
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

TEST_F(ProgramTest, SaysWhenItsOutputDoesNotArrive) {
  for (const auto& command :
       std::vector<std::string>{"stages", "--help", "run " + path("sum.yaml") + " -o " + path("out")}) {
    const std::string line = CRISP_PROGRAM " " + command +
                             (command == "--help" ? "" : " --plugin " TOY_PLUGIN) + " >/dev/full 2>" +
                             path("stderr");
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 1) << command;
    EXPECT_THAT(content("stderr"), HasSubstr("error: cannot write to the standard output"));
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

TEST_F(ProgramTest, RecordsNoLongerThanItWasToldAlsoWhereNoDeviceAnswers) {
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
    while (!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out")) std::this_thread::yield();
    kill(child, signal);
    const auto outcome = wait_for(child);
    EXPECT_EQ(outcome.status, status);
    EXPECT_THAT(outcome.error, HasSubstr("stopping; a second signal ends the program at once\n"));
    EXPECT_THAT(outcome.error, HasSubstr("interrupted: files that were not complete were not written\n"));
    EXPECT_FALSE(fs::exists(folder_ / "out/x.txt"));
    EXPECT_EQ(json("out/summary.json")["error"], "interrupted");
    EXPECT_EQ(json("out/summary.json")["exit_status"], status);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out"), {}), 1);
    fs::remove_all(folder_ / "out");
  }
}

TEST_F(ProgramTest, LeavesNoPartsOfFilesWhenItIsEndedAtOnce) {
  write_file(folder_ / "hang.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.hang, with: {file: ${output}/x.txt}}\n");
  for (const int second : {SIGINT, SIGTERM}) {
    const pid_t child = start({"run", path("hang.yaml"), "-o", path("out")});
    while (!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out")) std::this_thread::yield();
    kill(child, SIGINT);
    while (content("stderr").find("stopping") == std::string::npos) std::this_thread::yield();
    kill(child, second);
    EXPECT_EQ(wait_for(child).status, -second);
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
    fs::remove(folder_ / "out");
  }
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

TEST_F(ProgramTest, TellsAllOfAStage) {
  const auto outcome = crisp({"stages", "toy.write"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("toy.write: writes the sum (from "));
  EXPECT_THAT(outcome.out, HasSubstr("takes each Sum"));
  EXPECT_THAT(outcome.out, HasSubstr("true or false; default: false"));
  EXPECT_THAT(crisp({"stages"}).out, HasSubstr("write.calibration"));
  const auto wrong = crisp({"stages", "toy.wirte"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(wrong.error, "error: there is no stage 'toy.wirte'; did you mean 'toy.write'?\n");
}

TEST_F(ProgramTest, TellsAllOfAnEffect) {
  const auto outcome = crisp({"effects", "mirror.cone"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("mirror.cone: a laser's beam sweeps a cone"));
  EXPECT_THAT(outcome.out, HasSubstr("kappa"));
  EXPECT_THAT(outcome.out, HasSubstr("-0.1 to 0.1 rad; neutral: 0 rad"));
  EXPECT_THAT(crisp({"effects"}).out, HasSubstr("noise.mixed_pixels"));
  EXPECT_THAT(crisp({"effects", "--names"}).out, HasSubstr("\nplate.wobble\nrange.cyclic\n"));
  const auto wrong = crisp({"effects", "mirror.coin"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(wrong.error, "error: there is no effect 'mirror.coin'; did you mean 'mirror.cone'?\n");
}

TEST_F(ProgramTest, DescribesPipelinesAsAJsonSchema) {
  const auto schema = nlohmann::json::parse(crisp({"stages", "--json-schema"}).out);
  for (const auto& stage : schema["properties"]["pipeline"]["items"]["anyOf"]) {
    if (stage["properties"]["stage"]["const"] != "toy.write") continue;
    const auto& with = stage["properties"]["with"];
    EXPECT_EQ(with["required"], nlohmann::json({"file"}));
    EXPECT_EQ(with["properties"]["doubt"]["default"], false);
    EXPECT_EQ(stage["required"], nlohmann::json({"stage", "with"}));
    return;
  }
  FAIL() << "toy.write is not in the schema";
}

TEST_F(ProgramTest, ListsPluginsAndWhyTheyWereRefused) {
  EXPECT_EQ(crisp({"plugins"}).status, 0);
  const auto outcome = crisp({"plugins", "--plugin", FOREIGN_PLUGIN});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, HasSubstr("  refused: it was built for 'gcc-4"));
  EXPECT_THAT(outcome.out, HasSubstr("  toy 1.5\n"));
  const auto run = crisp({"run", path("sum.yaml"), "-o", path("out"), "--plugin", FOREIGN_PLUGIN});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error, HasSubstr("was refused"));
}

TEST_F(ProgramTest, SaysWhatACalibrationHolds) {
  write_file(folder_ / "c.yaml",
             "crisp: 1\nlasers:\n  a:\n    lambda: {value: 0, unit: rad}\n"
             "    tau: {value: 0.25, unit: m, std_error: 0.001, free: true}\n"
             "    alpha: {value: 0, unit: rad}\n    eta: {value: 0, unit: s}\n");
  const auto outcome = crisp({"info", path("c.yaml")});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("a calibration\n"));
  const auto data = nlohmann::json::parse(crisp({"info", path("c.yaml"), "--json"}).out);
  EXPECT_EQ(data["parameters"]["a.tau"]["value"], 0.25);
  EXPECT_EQ(data["parameters"]["a.tau"]["free"], true);

  write_file(folder_ / "noise", "\x01\x02");
  const auto unknown = crisp({"info", path("noise")});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.error, HasSubstr("is none of the kinds of files that are known"));
  EXPECT_EQ(crisp({"info", path("nowhere")}).status, 1);
  write_file(folder_ / "hub.pcap", "");
  EXPECT_EQ(crisp({"info", path("hub.pcap")}).error, "error: " + path("hub.pcap") + " is empty\n");
  EXPECT_EQ(crisp({"info", path("sum.yaml")}).error,
            "error: " + path("sum.yaml") + " is a pipeline; crisp validate checks it, crisp run runs it\n");
  EXPECT_THAT(crisp({"info", source_dir() + "/configs/rig.yaml"}).error, HasSubstr("rig.yaml is a rig; "));

  const auto folder = nlohmann::json::parse(crisp({"info", folder_.string(), "--json"}).out);
  EXPECT_EQ(folder.size(), 2U) << "noise is not counted, but hub.pcap ought to be a capture";
  EXPECT_EQ(folder[path("c.yaml")], data);
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(crisp({"info", path("empty")}).error, HasSubstr("holds no file of a kind that is known"));
}

TEST_F(ProgramTest, SaysWhatTheOthersHoldWhereOneCannotBeRead) {
  write_file(folder_ / "c.yaml",
             "crisp: 1\nlasers: {a: {lambda: {value: 0, unit: rad}, tau: {value: 0.25, unit: m}, "
             "alpha: {value: 0, unit: rad}, eta: {value: 0, unit: s}}}\n");
  write_file(folder_ / "hub.pcap", "");
  const std::string wrong = path("hub.pcap") + ": not read\nerror: " + path("hub.pcap") + " is empty\n";
  for (const auto& words : {std::vector{folder_.string()}, {path("hub.pcap"), path("c.yaml")}}) {
    auto request = words;
    request.insert(request.begin(), "info");
    const auto listing = crisp(request);
    EXPECT_EQ(listing.status, 1);
    EXPECT_THAT(listing.out, HasSubstr(path("c.yaml") + ": a calibration\n"));
    EXPECT_THAT(listing.out, HasSubstr(wrong));
    request.emplace_back("--json");
    const auto data = nlohmann::json::parse(crisp(request).out);
    EXPECT_EQ(data.size(), 2U);
    EXPECT_EQ(data[path("hub.pcap")]["error"], "error: " + path("hub.pcap") + " is empty");
    EXPECT_EQ(data[path("c.yaml")]["parameters"]["a.tau"]["value"], 0.25);
  }
  EXPECT_EQ(crisp({"info", path("c.yaml"), path("c.yaml")}).status, 0);
}

TEST_F(ProgramTest, SaysBeforeARecordingWhatItWouldDetermine) {
  const auto bound = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"bound", "-o", path("out"), "--duration", "1s"});
    return wait_for(start(words));
  };
  const Outcome turning = bound({"--scene", "hall", "--beams", "in_plane", "--motion", "reversal"});
  EXPECT_EQ(turning.status, 0) << turning.error;
  EXPECT_THAT(turning.out, HasSubstr("1 s in the hall: "));
  EXPECT_THAT(content("out/bound.csv"), HasSubstr("\nlaser2.lambda,rad,"));
  const Outcome steady = bound({"--beams", "in_plane", "--motion", "constant", "--max-rate", "1Hz"});
  EXPECT_EQ(steady.status, 0) << steady.error;
  EXPECT_THAT(steady.out, HasSubstr("laser2.lambda + 6.283 * laser2.eta"));  // a turn a second
  EXPECT_EQ(bound({"--motion", "sideways"}).status, 2);
}

TEST_F(ProgramTest, RepeatsARunOfTheMonteCarloAlone) {
  const fs::path out = folder_ / "out";
  const auto run = [&](const std::vector<std::string>& which) {
    std::vector<std::string> words = {"monte-carlo", "-o", out.string(), "-j", "1"};
    words.insert(words.end(), which.begin(), which.end());
    words.insert(words.end(),
                 {"--set", "study.monte_carlo.lasers=1", "--set", "study.monte_carlo.duration=4s"});
    return wait_for(start(words));
  };
  const Outcome both = run({"-n", "2", "--seed", "8"});
  EXPECT_EQ(both.status, 0) << both.error;
  EXPECT_THAT(both.out, HasSubstr("paper, Table 1"));
  EXPECT_THAT(both.out, HasSubstr("2 runs; "));
  const std::string all = content("out/monte_carlo.csv");
  const Outcome one = run({"--only", "9"});
  EXPECT_EQ(one.status, 0) << one.error;
  const std::string alone = content("out/monte_carlo.csv");
  EXPECT_EQ(alone.find("\n9,laser1.tau,"), alone.find('\n'));
  EXPECT_THAT(all, testing::EndsWith(alone.substr(alone.find('\n'))));
  EXPECT_EQ(run({"--only", "9", "-n", "2"}).status, 2);
}

TEST_F(ProgramTest, CompletesItsCommandLineInBash) {
  const auto completed = [&](const std::string& words, int at) {
    const std::string script = "source <(" CRISP_PROGRAM " completion bash); COMP_WORDS=(" + words +
                               "); COMP_CWORD=" + std::to_string(at) +
                               "; _crisp; printf '%s ' \"${COMPREPLY[@]}\"";
    write_file(folder_ / "script", script);
    EXPECT_EQ(std::system(("bash " + path("script") + " > " + path("completed")).c_str()), 0);
    return content("completed");
  };
  EXPECT_EQ(completed(CRISP_PROGRAM " va", 1), "validate ");
  EXPECT_EQ(completed(CRISP_PROGRAM " run --se", 2), "--set --seed ");
  EXPECT_EQ(completed(CRISP_PROGRAM " stages write.cal", 2), "write.calibration ");
  EXPECT_EQ(completed(CRISP_PROGRAM " effects noise.mi", 2), "noise.mixed_pixels ");
  EXPECT_EQ(completed(CRISP_PROGRAM " run --rig x", 3), " ");  // left to bash's own, which knows files
}

TEST_F(ProgramTest, ExplainsItself) {
  EXPECT_THAT(crisp({"--help"}).out, HasSubstr("Exit status: 0 done"));
  EXPECT_EQ(crisp({"--version"}).out, "crisp " CRISP_VERSION "\n");
  EXPECT_EQ(crisp({}).status, 2);
}

}  // namespace
}  // namespace crisp
