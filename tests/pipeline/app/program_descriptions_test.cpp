// SPDX-License-Identifier: BSD-3-Clause
// The program's descriptions of stages, effects, plugins and files, and its studies.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "tests/pipeline/app/program_fixture.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

TEST_F(ProgramTest, DescribesAStage) {
  const auto outcome = crisp({"stages", "toy.write"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("toy.write: writes the sum (from "));
  EXPECT_THAT(outcome.out, HasSubstr("takes each Sum"));
  EXPECT_THAT(outcome.out, HasSubstr("true or false; default: false"));
  EXPECT_THAT(crisp({"stages"}).out, HasSubstr("write.calibration"));
  const auto wrong = crisp({"stages", "toy.wirte"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(
      wrong.error,
      "error: there is no stage 'toy.wirte'; did you mean 'toy.write'? load a plugin's with --plugin FILE\n");
  const auto family = crisp({"stages", "toy"});
  EXPECT_EQ(family.status, 0);
  EXPECT_THAT(family.out, testing::StartsWith("toy.caveat "));
  EXPECT_THAT(family.out, testing::Not(HasSubstr("filter.range")));
}

TEST_F(ProgramTest, DescribesAnEffect) {
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
    EXPECT_EQ(with["properties"]["caveat"]["default"], false);
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

TEST_F(ProgramTest, OnlyListsWhatIsWrongInAFolderOfPluginsThatItWasNotRequested) {
  fs::create_directories(folder_ / "plugins");
  fs::copy_file(TOY_PLUGIN, folder_ / "plugins/cut.so");
  fs::resize_file(folder_ / "plugins/cut.so", 9000);
  fs::copy_file(TOY_PLUGIN, folder_ / "plugins/old_toy.so");
  setenv("CRISP_PLUGINS", path("plugins").c_str(), 1);
  const auto run = crisp({"run", path("sum.yaml"), "-o", path("out")});
  const auto list = crisp({"plugins"});
  unsetenv("CRISP_PLUGINS");
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(list.status, 0) << list.error;
  EXPECT_THAT(list.out, HasSubstr(path("plugins/cut.so") + "\n  refused: it is truncated"));
  EXPECT_THAT(list.out, HasSubstr(path("plugins/old_toy.so") +
                                  "\n  toy 1.5\n  skipped: already loaded from " TOY_PLUGIN "\n"));
}

TEST_F(ProgramTest, WarnsOfAFolderOfPluginsThatEveryoneMayWriteTo) {
  fs::create_directories(folder_ / "plugins");
  fs::copy_file(FOREIGN_PLUGIN, folder_ / "plugins/foreign.so");
  fs::copy_file(CLASHING_PLUGIN, folder_ / "plugins/clashing.so");
  fs::permissions(folder_ / "plugins", fs::perms::all);
  setenv("CRISP_PLUGINS", path("plugins").c_str(), 1);
  const auto run = crisp({"run", path("sum.yaml"), "-o", path("out")});
  unsetenv("CRISP_PLUGINS");
  EXPECT_THAT(run.error, HasSubstr("warning: the plugin " + path("plugins/clashing.so") +
                                   ": everyone may write to its folder, " + path("plugins")));
  EXPECT_THAT(run.error, Not(HasSubstr("foreign.so"))) << "nothing of it runs";
}

TEST_F(ProgramTest, RefusesTwoFilesOfOnePluginThatItWasBothRequested) {
  fs::copy_file(TOY_PLUGIN, folder_ / "copy.so");
  EXPECT_EQ(crisp({"stages", "--plugin", TOY_PLUGIN}).status, 0);
  const auto outcome = crisp({"stages", "--plugin", path("copy.so")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.error,
              HasSubstr("toy_plugin.so was refused: it is the plugin 'toy' once more, of which there is " +
                        path("copy.so") + "; load only one of the two"));
  EXPECT_THAT(crisp({"stages", "--plugin", CLASHING_PLUGIN}).error,
              HasSubstr("; give one of them another name, or load only one of the two"));
}

TEST_F(ProgramTest, DescribesACalibration) {
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
  EXPECT_THAT(unknown.error, HasSubstr("is of no known kind of file"));
  EXPECT_EQ(crisp({"info", path("nowhere")}).status, 1);
  write_file(folder_ / "hub.pcap", "");
  EXPECT_EQ(crisp({"info", path("hub.pcap")}).error,
            "error: " + path("hub.pcap") + " is empty; copy or record it again\n");
  EXPECT_EQ(crisp({"info", path("sum.yaml")}).error,
            "error: " + path("sum.yaml") + " is a pipeline; crisp validate checks it, crisp run runs it\n");
  EXPECT_THAT(crisp({"info", source_dir() + "/configs/rig.yaml"}).error, HasSubstr("rig.yaml is a rig; "));

  const auto folder = nlohmann::json::parse(crisp({"info", folder_.string(), "--json"}).out);
  EXPECT_EQ(folder.size(), 2U) << "noise is not counted, but hub.pcap ought to be a capture";
  EXPECT_EQ(folder[path("c.yaml")], data);
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(crisp({"info", path("empty")}).error, HasSubstr("holds no file of a known kind"));
}

TEST_F(ProgramTest, ReportsThatACalibrationWasUntrusted) {
  write_file(
      folder_ / "c.yaml",
      "crisp: 1\ndoubts: [it is only a toy]\nlasers: {a: {lambda: {value: 0, unit: rad}, tau: {value: 0.25, unit: m}, alpha: {value: 0, unit: rad}, eta: {value: 0, unit: s}}}\n");
  EXPECT_THAT(crisp({"info", path("c.yaml")}).out, HasSubstr("\n  UNTRUSTED: it is only a toy\n"));
  const auto data = nlohmann::json::parse(crisp({"info", path("c.yaml"), "--json"}).out);
  EXPECT_EQ(data["caveats"], nlohmann::json({"it is only a toy"}));
}

TEST_F(ProgramTest, PutsTwoCalibrationsSideBySide) {
  for (const char* name : {"a.yaml", "b.yaml"}) {
    write_file(
        folder_ / name,
        "crisp: 1\nlasers: {a: {lambda: {value: 0, unit: rad}, tau: {value: 0.25, unit: m}, alpha: {value: 0, unit: rad}, eta: {value: 0, unit: s}}}\n");
  }
  const auto outcome = crisp({"info", path("a.yaml"), path("b.yaml")});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.out, testing::StartsWith("first:  " + path("a.yaml") + ": a calibration\nsecond: "));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("a.tau +mm +250.0000 +250.0000 +0.0000"));
  const auto data = nlohmann::json::parse(crisp({"info", path("a.yaml"), path("b.yaml"), "--json"}).out);
  EXPECT_EQ(data.size(), 2U);
}

TEST_F(ProgramTest, DescribesTheOtherFilesWhereOneIsUnreadable) {
  write_file(
      folder_ / "c.yaml",
      "crisp: 1\nlasers: {a: {lambda: {value: 0, unit: rad}, tau: {value: 0.25, unit: m}, alpha: {value: 0, unit: rad}, eta: {value: 0, unit: s}}}\n");
  write_file(folder_ / "hub.pcap", "");
  const std::string wrong =
      path("hub.pcap") + ": not read\nerror: " + path("hub.pcap") + " is empty; copy or record it again\n";
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
    EXPECT_EQ(data[path("hub.pcap")]["error"],
              "error: " + path("hub.pcap") + " is empty; copy or record it again");
    EXPECT_EQ(data[path("c.yaml")]["parameters"]["a.tau"]["value"], 0.25);
  }
  EXPECT_EQ(crisp({"info", path("c.yaml"), path("c.yaml")}).status, 0);
}

TEST_F(ProgramTest, ComputesTheBoundBeforeARecording) {
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

/// What a study is called with, small enough for a test.
std::vector<std::string> small_study(const std::string& command, const fs::path& output,
                                     const std::vector<std::string>& more) {
  std::vector<std::string> words = {
      command, "-n", command == "basin" ? "6" : "5", "--seed", "8", "-j", "1", "-o", output.string()};
  words.insert(words.end(), more.begin(), more.end());
  const std::string stage = command == "basin" ? "study.basin." : "study.monte_carlo.";
  words.insert(words.end(), {"--set", stage + "lasers=1", "--set", stage + "duration=4s"});
  if (command == "basin") words.insert(words.end(), {"--set", stage + "starts_per_recording=2"});
  return words;
}

TEST_F(ProgramTest, MergesPartsOfAStudyToTheBytesOfOneMachine) {
  for (const std::string command : {"monte-carlo", "basin"}) {
    const fs::path alone = folder_ / command / "alone";
    const fs::path parts = folder_ / command / "parts";
    const int status = wait_for(start(small_study(command, alone, {}))).status;
    const auto early = wait_for(start(small_study(command, parts, {"--merge"})));
    EXPECT_EQ(early.status, 1);
    EXPECT_THAT(early.error, HasSubstr("run the parts with --shard i/n"));
    for (const char* shard : {"1/2", "2/2"}) {
      const auto part = wait_for(start(small_study(command, parts, {"--shard", shard})));
      EXPECT_EQ(part.status, 0) << part.error;
    }
    const auto merged = wait_for(start(small_study(command, parts, {"--merge"})));
    EXPECT_EQ(merged.status, status) << merged.error;
    for (const char* file : {"monte_carlo.csv", "table1.txt", "basin.csv"}) {
      EXPECT_EQ(fs::exists(parts / file), fs::exists(alone / file));
      if (!fs::exists(alone / file)) continue;
      EXPECT_EQ(read_text_file(parts / file, 1 << 24), read_text_file(alone / file, 1 << 24)) << file;
    }
    EXPECT_EQ(wait_for(start(small_study(command, parts, {"--shard", "3/2"}))).status, 2);
    EXPECT_EQ(wait_for(start(small_study(command, parts, {"--shard", "1/2", "--merge"}))).status, 2);
  }
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
  EXPECT_EQ(completed(CRISP_PROGRAM " batch st", 2), "status ");
  EXPECT_EQ(completed(CRISP_PROGRAM " batch status --w", 3), "--watch ");
  EXPECT_EQ(completed(CRISP_PROGRAM " batch retry --ma", 3), "--match --mark ");
  EXPECT_EQ(completed(CRISP_PROGRAM " batch retry --jo", 3), "--jobs ");
  EXPECT_EQ(completed(CRISP_PROGRAM " batch table --j", 3), "--json ");
  EXPECT_EQ(completed(CRISP_PROGRAM " batch p.yaml --sh", 3), "--shard ");
  EXPECT_EQ(completed(CRISP_PROGRAM " batch p.yaml st", 3), " ");  // a file
  EXPECT_EQ(completed(CRISP_PROGRAM " cluster s", 2), "submit ");
  EXPECT_EQ(completed(CRISP_PROGRAM " cluster submit --ta", 3), "--tasks ");
  EXPECT_EQ(completed(CRISP_PROGRAM " run --rig x", 3), " ");  // left to bash's own, which knows files
  EXPECT_EQ(completed(CRISP_PROGRAM " study bound --scene of", 4), "office ");
  EXPECT_EQ(completed(CRISP_PROGRAM " emulate --motion st", 3), "stop_and_go ");
  EXPECT_EQ(completed(CRISP_PROGRAM " study bound --duration 1", 4),
            " ");  // no list, and no file of that name

  // Behind --set: of the pipeline its variables, tags and options; bash divides name=value into three words.
  const std::string run = CRISP_PROGRAM " run " + path("sum.yaml") + " -o x --set ";
  write_file(folder_ / "sum.yaml",
             "crisp: 1\nvars: {limit: 3}\npipeline:\n"
             "  - {stage: grabber.simulate, tag: first, with: {duration: 1s}}\n");
  EXPECT_EQ(completed(run + "''", 6).substr(0, 13), "limit= first.");
  EXPECT_EQ(completed(run + "first.motion.min_r", 6), "first.motion.min_rate= ");
  EXPECT_EQ(completed(run + "first.motion.kind = co", 8), "constant ");
  EXPECT_EQ(completed(run + "first.motion.kind =", 7), "constant varying reversal stop_and_go ");
  EXPECT_EQ(completed(run + "first.motion.kind=co", 6), "first.motion.kind=constant ")
      << "where = divides no words";
  EXPECT_EQ(completed(CRISP_PROGRAM " run picture --set calibr", 4), "calibration= calibrate.load.file= ");
  EXPECT_EQ(completed(CRISP_PROGRAM " calibrate hub.pcap --set clock.convex_hull.win", 4),
            "clock.convex_hull.window= ");
  EXPECT_EQ(completed(CRISP_PROGRAM " run --set filter.vox", 3), "filter.voxel.size= ") << "of all stages";
  EXPECT_EQ(completed(CRISP_PROGRAM " run none.yaml --set filter.vox", 4), "filter.voxel.size= ");
}

TEST_F(ProgramTest, ExplainsItself) {
  EXPECT_THAT(crisp({"--help"}).out, HasSubstr("Exit status: 0 success"));
  EXPECT_EQ(crisp({"--version"}).out, "crisp " CRISP_VERSION "\n");
  EXPECT_EQ(crisp({}).status, 2);
}

}  // namespace
}  // namespace crisp
