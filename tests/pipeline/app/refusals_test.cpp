// SPDX-License-Identifier: BSD-3-Clause
// What the program refuses of pipelines: files that would overwrite each other, and all mistakes at once.
#include <gmock/gmock.h>

#include <csignal>
#include <iterator>

#include "pipeline/files/folder_lock.hpp"
#include "tests/pipeline/app/program_fixture.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
namespace fs = std::filesystem;
using testing::HasSubstr;

TEST_F(ProgramTest, EndsWithTwoAndEveryMistakeWhenThePipelineIsWrong) {
  write_file(folder_ / "wrong.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.sum}\n  - {stage: toy.count, with: {m: 4}}\n");
  const std::string expected =
      path("wrong.yaml") +
      ":3:13: error: toy.sum: nothing above it gives the Number that it takes; put one of these above it: toy.caveat, toy.count, toy.endless, toy.share, toy.throw, toy.wait\n" +
      path("wrong.yaml") + ":4:31: error: toy.count: there is no option 'm'; did you mean 'n'?\n2 errors\n";
  for (const std::string command : {"run", "validate"}) {
    const auto outcome = crisp({command, path("wrong.yaml")});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.error, expected);
  }
  const Outcome study = crisp({"monte-carlo", "--set", "study.monte_carlo.devices=lms11"});
  EXPECT_EQ(study.status, 2);
  EXPECT_THAT(study.error, HasSubstr("did you mean 'lms111'?"));
}

TEST_F(ProgramTest, RefusesToOverwriteWhatItReadsOrHasWritten) {
  const auto error_of = [&](const std::string& stages) {
    write_file(folder_ / "files.yaml", "crisp: 1\npipeline:\n" + stages);
    const auto outcome = crisp({"run", path("files.yaml"), "-i", path("in.yaml"), "-o", path("out")});
    EXPECT_EQ(outcome.status, 2);
    return outcome.error;
  };
  write_file(folder_ / "in.yaml", "kept");
  fs::create_symlink(folder_, folder_ / "link");
  EXPECT_EQ(error_of("  - {stage: calibrate.load, with: {file: \"${input}\"}}\n"
                     "  - {stage: write.calibration, with: {file: link/in.yaml}}\n"),
            path("files.yaml") + ":4:45: error: write.calibration: it would overwrite " + path("in.yaml") +
                ", which calibrate.load reads; let it write another file\n");
  EXPECT_EQ(content("in.yaml"), "kept");
  EXPECT_THAT(error_of("  - stage: toy.count\n  - stage: toy.sum\n"
                       "  - {stage: toy.write, with: {file: \"${output}/x\"}}\n"
                       "  - {stage: toy.write, with: {file: \"${output}/./x\"}}\n"),
              HasSubstr(":6:37: error: toy.write-2: it would overwrite " + path("out/x") +
                        ", which toy.write writes;"));
  EXPECT_THAT(error_of("  - stage: toy.count\n  - stage: toy.sum\n"
                       "  - {stage: toy.write, with: {file: files.yaml}}\n"),
              HasSubstr("toy.write: it would overwrite " + path("files.yaml") + ", which this run reads;"));
  EXPECT_THAT(error_of("  - stage: toy.count\n  - stage: toy.sum\n"
                       "  - {stage: toy.write, with: {file: \"${output}/summary.json\"}}\n"),
              HasSubstr(":5:37: error: toy.write: it would overwrite " + path("out/summary.json") +
                        ", which this run writes; let it write another file"));
}

TEST_F(ProgramTest, RefusesAFolderThatAnotherProcessWritesInto) {
  fs::create_directory(folder_ / "out");
  const FolderLock lock(folder_ / "out");
  const std::string out = path("out");
  const std::vector<std::vector<std::string>> commands = {
      {"run", path("sum.yaml"), "-o", out},
      {"record", "-o", out},
      {"bound", "-o", out},
      {"stages", "--markdown", "--output", out},
  };
  for (const auto& command : commands) {
    const auto outcome = crisp(command);
    EXPECT_EQ(outcome.status, 2) << command.front();
    EXPECT_THAT(outcome.error,
                HasSubstr("the folder " + out + " is in use: process " + std::to_string(getpid()) + " on "));
    EXPECT_THAT(outcome.error, HasSubstr("wait for its end, or give another folder"));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 1) << "the lock";
}

TEST_F(ProgramTest, RefusesASecondRunIntoAFolderAndLetsTheFirstGoOn) {
  write_file(folder_ / "wait.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.wait, with: {file: ${output}/x.txt}}\n");
  const pid_t first = start({"run", path("wait.yaml"), "-o", path("out")});
  wait_for_part();
  const auto second = crisp({"run", path("sum.yaml"), "-o", path("out")});
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.error, HasSubstr("process " + std::to_string(first) + " on "));
  kill(first, SIGINT);
  EXPECT_EQ(wait_for(first).status, 130);
  EXPECT_EQ(json("out/summary.json")["pipeline"], path("wait.yaml"));
}

TEST_F(ProgramTest, TakesOverTheFolderOfARunThatWasKilled) {
  write_file(folder_ / "wait.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.wait, with: {file: ${output}/x.txt}}\n");
  const pid_t killed = start({"run", path("wait.yaml"), "-o", path("out")});
  wait_for_part();
  kill(killed, SIGKILL);
  EXPECT_EQ(wait_for(killed).status, -SIGKILL);
  EXPECT_EQ(crisp({"run", path("sum.yaml"), "-o", path("out")}).status, 0);
  EXPECT_EQ(content("out/sum.txt"), "10\n");
}

TEST_F(ProgramTest, RefusesAnInputThatLiesWhereTheRunWrites) {
  fs::create_directory(folder_ / "out");
  write_file(folder_ / "out/summary.json", "kept");
  fs::create_symlink("out/summary.json", folder_ / "link.json");
  for (const std::string input : {"out/summary.json", "link.json"}) {
    const auto outcome = crisp({"run", path("sum.yaml"), "-i", path(input), "-o", path("out")});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.error, HasSubstr("this run: it would overwrite " + path("out/summary.json") +
                                         ", which this run reads; "));
  }
  EXPECT_EQ(content("out/summary.json"), "kept");
  const std::string pipeline = content("sum.yaml");
  for (const std::string name : {"out/summary.json", "out/sum.txt", "out/sum.txt.provenance.json"}) {
    write_file(folder_ / name, pipeline);
    const auto outcome = crisp({"run", path(name), "-o", path("out")});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.error, HasSubstr("it would overwrite " + path(name) + ", which this run reads; "));
    EXPECT_EQ(content(name), pipeline);
    fs::remove(folder_ / name);
  }
}

TEST_F(ProgramTest, RefusesToRecordIntoTheFolderWhoseCapturesItReads) {
  fs::create_directory(folder_ / "captures");
  write_file(folder_ / "captures/hub.pcap", "kept");
  write_file(folder_ / "copy.yaml",
             "crisp: 1\npipeline:\n  - {stage: grabber.capture, with: {file: \"${input}\"}}\n"
             "  - {stage: write.capture, with: {file: \"${output}/copy.pcap\"}}\n");
  const auto outcome = crisp({"run", path("copy.yaml"), "-i", path("captures"), "-o", path("captures")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.error,
              HasSubstr("write.capture: its " + path("captures/copy.pcap") + " could overwrite " +
                        path("captures/*.pcap") + ", which grabber.capture reads; "));
  EXPECT_EQ(content("captures/hub.pcap"), "kept");
  EXPECT_FALSE(fs::exists(folder_ / "captures/copy.pcap"));
}

TEST_F(ProgramTest, ReplacesLinksAndLeavesTheFilesThatTheyLeadToAlone) {
  fs::create_directory(folder_ / "out");
  const std::vector<std::string> names = {"sum.txt", "sum.txt.provenance.json", "summary.json"};
  for (const auto& name : names) {
    write_file(folder_ / ("precious " + name), "precious");
    fs::create_symlink(folder_ / ("precious " + name), folder_ / "out" / name);
  }
  EXPECT_EQ(crisp({"run", path("sum.yaml"), "-o", path("out")}).status, 0);
  EXPECT_EQ(content("out/sum.txt"), "10\n");
  for (const auto& name : names) {
    EXPECT_FALSE(fs::is_symlink(folder_ / "out" / name)) << name;
    EXPECT_EQ(content("precious " + name), "precious");
  }
}

TEST_F(ProgramTest, RefusesToOverwriteWhatComesOfAnotherStagesFile) {
  const auto error_of = [&](const std::string& one, const std::string& other) {
    write_file(folder_ / "files.yaml",
               "crisp: 1\npipeline:\n  - {stage: grabber.capture, with: {file: x}}\n"
               "  - stage: clock.convex_hull\n  - stage: assemble.deskew\n  - " +
                   one + "\n  - " + other + "\n");
    const auto outcome = crisp({"validate", path("files.yaml")});
    EXPECT_EQ(outcome.status, outcome.error.empty() ? 0 : 2);
    return outcome.error;
  };
  const auto page = [](const std::string& name) {
    return "{stage: write.report, with: {file: \"${output}/" + name + "\"}}";
  };
  const std::string cloud = "{stage: write.pcd, with: {file: \"${output}/a.pcd\"}}";
  const std::string beams = "{stage: write.measurements, with: {file: \"${output}/a.pcd\"}}";
  EXPECT_THAT(
      error_of(cloud, page("a_0001.pcd")),
      HasSubstr(
          ":7:40: error: write.report: its /output/a_0001.pcd could overwrite /output/a_*.pcd, which write.pcd writes; let it write another file"));
  EXPECT_THAT(error_of(page("a_0001.pcd"), cloud), HasSubstr("its /output/a_*.pcd could overwrite"));
  EXPECT_THAT(error_of(beams, page("a.plate.pcd")),
              HasSubstr("write.report: it would overwrite /output/a.plate.pcd, which write.measurements"));
  EXPECT_THAT(error_of(beams, page("a_0002.plate.pcd")), HasSubstr("/output/a_*.plate.pcd"));
  EXPECT_THAT(error_of(cloud, page("a.pcd.provenance.json")), HasSubstr("which write.pcd writes"));
  EXPECT_THAT(error_of(page("summary.json"), cloud), HasSubstr("which this run writes"));
  const std::string clouds = "{stage: write.clouds, with: {file: \"${output}/a.pcd\"}}";
  EXPECT_THAT(error_of(clouds, page("a_0001.pcd")), HasSubstr("which write.clouds writes"));
  const std::string stamps = "{stage: diagnose.clocks, with: {folder: \"${output}\"}}";
  EXPECT_THAT(error_of(stamps, page("laser1_stamps.svg")),
              HasSubstr("could overwrite /output/*_stamps.svg, which diagnose.clocks writes"));
  EXPECT_THAT(error_of("{stage: write.capture, with: {file: \"${output}/h.pcap\"}}", page("h-2.pcap")),
              HasSubstr("could overwrite /output/h-*.pcap, which write.capture writes"));
  for (const auto* other :
       {"a_1.png", "a_1.pcd", "a_001.pcd", "a_plate.pcd", "b_0001.pcd", "deeper/a_0001.pcd", "stamps.svg"}) {
    EXPECT_EQ(error_of(cloud, page(other)), "") << other;
    EXPECT_EQ(error_of(stamps, page(other)), "") << other;
  }
}

TEST_F(ProgramTest, DoesNotReplaceWhatAStageWroteByARecordOfItsOwn) {
  write_file(folder_ / "hidden.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.sum}\n"
             "  - {stage: toy.write_undeclared, with: {folder: \"${output}\", name: summary.json}}\n");
  const auto run = crisp({"run", path("hidden.yaml"), "-o", path("out")});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error,
              HasSubstr("error: toy.write_undeclared: it wrote " + path("out/summary.json") +
                        ", which is the name of the run's own record; let it write another file\n"));
  EXPECT_EQ(content("out/summary.json"), "undeclared");
  write_file(folder_ / "twice.yaml",
             "crisp: 1\npipeline:\n  - {stage: toy.count}\n  - {stage: toy.sum}\n"
             "  - {stage: toy.write, with: {file: \"${output}/x\"}}\n"
             "  - {stage: toy.write_undeclared, with: {folder: \"${output}\", name: x}}\n");
  const auto twice = crisp({"run", path("twice.yaml"), "-o", path("out")});
  EXPECT_EQ(twice.status, 1);
  EXPECT_THAT(twice.error, HasSubstr(":6:13: error: toy.write_undeclared: it has overwritten " +
                                     path("out/x") + ", which toy.write wrote; let it write another file"));
}

TEST_F(ProgramTest, RefusesToRunWhereAFolderIsInTheWayOfWhatItWouldWrite) {
  fs::create_directories(folder_ / "out/sum.txt");
  const auto file = crisp({"run", path("sum.yaml"), "-o", path("out")});
  EXPECT_EQ(file.status, 2);
  EXPECT_EQ(file.error, path("sum.yaml") + ":5:37: error: toy.write: where " + path("out/sum.txt") +
                            " would be written there is a folder; remove the folder, or name another file\n");
  fs::remove(folder_ / "out/sum.txt");
  fs::create_directories(folder_ / "out/sum.txt.provenance.json");
  fs::create_directories(folder_ / "out/summary.json");
  const auto records = crisp({"run", path("sum.yaml"), "-o", path("out")});
  EXPECT_THAT(records.error,
              HasSubstr("toy.write: where " + path("out/sum.txt.provenance.json") + " would be"));
  EXPECT_THAT(records.error, HasSubstr("error: this run: where " + path("out/summary.json") + " would be"));
}

TEST_F(ProgramTest, SuggestsTheNearestNameForUnknownWords) {
  const auto thread = crisp({"run", path("sum.yaml"), "--thread", "4", "--sead=1"});
  EXPECT_EQ(thread.status, 2);
  EXPECT_EQ(thread.error,
            "error: not expected: --thread 4 --sead=1; did you mean '--threads'?; see crisp run --help\n");
  EXPECT_EQ(crisp({"plugins", "one", "two"}).error,
            "error: not expected: one two; see crisp plugins --help\n");
  EXPECT_EQ(crisp({"run"}).error, "error: pipeline is required; see crisp run --help\n");
}

TEST_F(ProgramTest, RefusesAFolderThatHoldsNoPlugin) {
  fs::create_directories(folder_ / "none");
  const auto outcome = crisp({"stages", "--plugin", path("none")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.error,
            "error: the folder " + path("none") + " holds no plugin; plugins are files NAME.so\n");
}

TEST_F(ProgramTest, ReportsInASentenceThatAnInputCannotBeRead) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  const auto loop = crisp({"run", path("sum.yaml"), "-i", path("a"), "-o", path("out")});
  EXPECT_EQ(loop.status, 2);
  EXPECT_EQ(loop.error,
            "error: the input " + path("a") +
                " cannot be read: Too many levels of symbolic links; check its path and its permissions\n");
  fs::create_directory(folder_ / "folder");
  write_file(folder_ / "list.yaml",
             "crisp: 1\npipeline:\n  - {stage: grabber.telegrams, with: {file: folder}}\n");
  const auto folder = crisp({"run", path("list.yaml"), "-o", path("out")});
  EXPECT_EQ(folder.status, 1);
  EXPECT_THAT(folder.error, HasSubstr("grabber.telegrams: cannot read " + path("folder") +
                                      ": Is a directory; name a file in it"));
}

TEST_F(ProgramTest, RefusesALineBreakInASetting) {
  for (const std::string character : {"\n", "\x1b"}) {
    const auto outcome = crisp({"run", path("sum.yaml"), "-o", path("out"), "--set",
                                "toy.write.file=" + path("a") + character + "b"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.error, HasSubstr("a setting is one line of text, but there is a control character"));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
}

TEST_F(ProgramTest, ShowsTheSyntaxOfAStage) {
  write_file(folder_ / "plain.yaml", "crisp: 1\npipeline:\n  - toy.count\n");
  EXPECT_EQ(
      crisp({"validate", path("plain.yaml")}).error,
      path("plain.yaml") + ":3:5: error: stage: 'toy.count' is not a map; write `- stage: toy.count`\n");
}

TEST_F(ProgramTest, DistinguishesAStageFromTheKeyBeforeItAndAListFromItsBrackets) {
  for (const char* item : {"stage toy.count", "stage:toy.count"}) {
    write_file(folder_ / "plain.yaml", "crisp: 1\npipeline:\n  - " + std::string(item) + "\n");
    EXPECT_THAT(crisp({"validate", path("plain.yaml")}).error, HasSubstr("; write `- stage: toy.count`\n"));
  }
  const auto outcome =
      crisp({"validate", source_dir() + "/configs/calibrate.yaml", "--set", "calibrate.rqe.sigma=50cm,1cm"});
  EXPECT_THAT(outcome.error, HasSubstr("; did you mean [50cm, 1cm]? expected is a list"));
}

TEST_F(ProgramTest, ValidatesEveryStageThoughAnotherIsWrong) {
  const auto errors_of = [&](const std::string& rig) {
    write_file(folder_ / "wrong.yaml",
               "crisp: 1\n" + rig +
                   "pipeline:\n  - {stage: grabber.capture, with: {file: x}}\n  - stage: clock.convex_hull\n"
                   "  - {stage: filter.range, with: {range: [9m, 1m], lasers: [nobody]}}\n"
                   "  - {stage: assemble.deskew, with: {nonsense: 1}}\n"
                   "  - {stage: filter.crop, with: {x: [2m, 1m], z: [4m, 3m]}}\n"
                   "  - {stage: write.pcd, with: {file: \"${output}/a.pcd\"}}\n"
                   "  - {stage: write.report, with: {file: \"${output}/a.pcd\"}}\n");
    return crisp({"validate", path("wrong.yaml")}).error;
  };
  const std::string all = errors_of("");
  const auto has = [](const std::string& text) { return HasSubstr(text); };
  EXPECT_THAT(all, has(":5:59: error: filter.range: the rig has no laser 'nobody'"));
  EXPECT_THAT(all, has(":5:41: error: filter.range: range"));
  EXPECT_THAT(all, has("error: assemble.deskew: there is no option 'nonsense'"));
  EXPECT_THAT(all, has(":7:36: error: filter.crop: x"));
  EXPECT_THAT(all, has(":7:49: error: filter.crop: z"));
  EXPECT_THAT(all, has("error: write.report: it would overwrite /output/a.pcd, which write.pcd writes"));
  EXPECT_THAT(all, testing::EndsWith("\n6 errors\n"));
  const std::string of_a_rig = errors_of("rig: {crisp: 1, plate: {}}\n");
  EXPECT_THAT(of_a_rig, has(":2:6: error: rig: 'lasers' is missing"));
  EXPECT_THAT(of_a_rig, has("assemble.deskew: there is no option 'nonsense'"));
  EXPECT_THAT(of_a_rig, has("write.report: it would overwrite"));
  EXPECT_THAT(of_a_rig, testing::Not(has("nobody"))) << "which lasers there are is not known";
}

TEST_F(ProgramTest, ReportsThatASettingIsWrongWhereItIsGiven) {
  const auto error_of = [&](const std::string& pipeline, const std::string& setting) {
    return crisp({"validate", source_dir() + "/configs/" + pipeline, "--set", setting}).error;
  };
  for (const std::string setting :
       {"calibrate.refine.fixed=laser1.tua", "calibrate.refine.terms=cone", "calibrate.rqe.measure=none"}) {
    EXPECT_THAT(error_of("calibrate.yaml", setting), testing::StartsWith("--set " + setting + ": error: "));
  }
  const std::string effects = "grabber.simulate.effects={laser2.mirror.eccentricty: {a: 0.1deg}}";
  EXPECT_THAT(error_of("simulate.yaml", effects),
              testing::StartsWith("--set " + effects + ": error: grabber.simulate: there is no effect"));
}

}  // namespace
}  // namespace crisp
