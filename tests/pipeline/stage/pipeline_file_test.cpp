// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crisp/atomic_file.hpp>
#include <crisp/pipeline.hpp>

#include "pipeline/stage/pipeline_plan.hpp"
#include "tests/pipeline/stage/toy_stages.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using namespace crisp::stage;
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// One option of every type, as a pipeline can give them.
class EverythingStage final : public Stage {
 public:
  enum class Search { flann, grid, exact };

  static void describe(StageDescription<EverythingStage>& d) {
    d.name("toy.everything").summary("has options of every type");
    d.option("flag", &EverythingStage::flag, "yes or no");
    d.option("count", &EverythingStage::count, "how many").range(0, 100);
    d.option("length", &EverythingStage::length, "how long").unit("m").range(1e-4, 10);
    d.option("ratio", &EverythingStage::ratio, "how much").unit("1");
    d.option("word", &EverythingStage::word, "what");
    d.option("search", &EverythingStage::search, "which way")
        .choices({{"flann", Search::flann}, {"grid", Search::grid}, {"exact", Search::exact}});
    d.option("sigma", &EverythingStage::sigma, "how wide").unit("m").range(1e-4, 10).count(1, 9);
    d.option("names", &EverythingStage::names, "who");
    d.option("window", &EverythingStage::window, "duration of the window").unit("s").at_least(0);
    d.option("file", &EverythingStage::file, "where").required();
  }
  void check(const RunSettings&) const override {
    if (count == 13) throw Error("13 is an unlucky count", "take 12");
  }
  void process(const Inputs&, Outputs&, Context&) override {}

  bool flag = false;
  int count = 1;
  double length = 1;
  double ratio = 1;
  std::string word = "none";
  Search search = Search::flann;
  std::vector<double> sigma = {0.5};
  std::vector<std::string> names;
  std::optional<double> window;
  fs::path file;
};

class PipelineFileTest : public testing::Test {
 protected:
  PipelineFileTest() {
    toy::register_toys(registrar_);
    registrar_.stage<EverythingStage>();
    run_.registrar = &registrar_;
  }

  /// All the errors of a pipeline file in /there, of this text.
  std::vector<std::string> errors_of(const std::string& text, const PipelineArguments& arguments = {}) {
    std::vector<Error> errors;
    pipeline_ = read(text, arguments, errors);
    std::vector<std::string> texts;
    for (const auto& error : errors) texts.emplace_back(error.what());
    return texts;
  }

  Pipeline read(const std::string& text, const PipelineArguments& arguments, std::vector<Error>& errors) {
    const auto plan =
        parse_plan(parse_yaml(text, "p.yaml"), "/there", arguments, registrar_.stages(), errors);
    run_.rig = plan.rig;
    return build_pipeline(plan.stages, run_, errors);
  }

  const EverythingStage& everything() const {
    return dynamic_cast<const EverythingStage&>(*pipeline_.nodes.at(0).stage);
  }

  static std::string with(const std::string& options) {
    return "crisp: 1\npipeline:\n  - stage: toy.everything\n    with: {" + options + "}\n";
  }

  Registrar registrar_;
  RunSettings run_;
  Pipeline pipeline_;
};

TEST_F(PipelineFileTest, ReadsOptionsOfEveryTypeAndConvertsTheirUnits) {
  EXPECT_THAT(
      errors_of(with(
          "flag: true, count: 7, length: 5cm, ratio: 250ppm, word: two words, search: grid, sigma: [50cm, 1cm, 0.002], names: [a, b], window: 20ms, file: x/../y.txt")),
      IsEmpty());
  const auto& e = everything();
  EXPECT_TRUE(e.flag);
  EXPECT_EQ(e.count, 7);
  EXPECT_DOUBLE_EQ(e.length, 0.05);
  EXPECT_DOUBLE_EQ(e.ratio, 2.5e-4);
  EXPECT_EQ(e.word, "two words");
  EXPECT_EQ(e.search, EverythingStage::Search::grid);
  EXPECT_THAT(e.sigma, ElementsAre(0.5, 0.01, 0.002));
  EXPECT_THAT(e.names, ElementsAre("a", "b"));
  EXPECT_EQ(e.window, 0.02);
  EXPECT_EQ(e.file, "/there/y.txt");
}

TEST_F(PipelineFileTest, LeavesWhatIsNotGivenAtItsDefault) {
  EXPECT_THAT(errors_of(with("file: /y, window: auto, sigma: 3cm")), IsEmpty());
  EXPECT_EQ(everything().count, 1);
  EXPECT_EQ(everything().word, "none");
  EXPECT_EQ(everything().window, std::nullopt);
  EXPECT_THAT(everything().sigma, ElementsAre(0.03));
}

TEST_F(PipelineFileTest, RefusesEachWrongValueAtItsPlaceAndReportsWhatWasExpected) {
  EXPECT_THAT(
      errors_of("crisp: 1\n"
                "pipeline:\n"
                "  - stage: toy.everything\n"
                "    tag: all\n"
                "    with:\n"
                "      flag: yes\n"
                "      count: 010\n"
                "      length: 5kg\n"
                "      ratio: 5cm\n"
                "      word: [a]\n"
                "      search: gird\n"
                "      sigma: [50cm, 20m, x]\n"
                "      window: -1s\n"
                "      lenght: 5\n"),
      testing::UnorderedElementsAre(
          "p.yaml:6:13: error: all: option 'flag': 'yes' is neither true nor false; expected is true or false",
          "p.yaml:7:14: error: all: option 'count': '010' begins with 0, which is ambiguous; expected is a whole number, 0 to 100",
          "p.yaml:8:15: error: all: option 'length': '5kg' has the unknown unit 'kg'; understood are m, um, µm, mm, cm, km; expected is a number in m, 0.0001 to 10",
          "p.yaml:9:14: error: all: option 'ratio': '5cm' cannot be converted to a number without dimension; expected is a number",
          "p.yaml:10:13: error: all: option 'word': a list is not a text; expected is a text",
          "p.yaml:11:15: error: all: option 'search': 'gird' is not one of its names; did you mean 'grid'? expected is one of flann, grid, exact",
          "p.yaml:12:21: error: all: option 'sigma': 20m is out of range; expected is a list, each a number in m, 0.0001 to 10, 1 or more of them, 9 at most",
          "p.yaml:12:26: error: all: option 'sigma': 'x' is not a number; expected is a list, each a number in m, 0.0001 to 10, 1 or more of them, 9 at most",
          "p.yaml:13:15: error: all: option 'window': -1s is out of range; expected is a number in s, at least 0, or auto",
          "p.yaml:14:7: error: all: there is no option 'lenght'; did you mean 'length'?",
          "p.yaml:3:12: error: all: option 'file' is missing (where); expected is a path"));
}

TEST_F(PipelineFileTest, ReportsALimitInTheUnitInWhichTheValueWasWritten) {
  EXPECT_THAT(errors_of(with("file: x, length: 2000cm, window: -20 ms")),
              ElementsAre(HasSubstr("2000cm is out of range; expected is a number in cm, 0.01 to 1000"),
                          HasSubstr("-20ms is out of range; expected is a number in ms, at least 0")));
}

TEST_F(PipelineFileTest, ReportsOnceThatARequiredOptionIsWrong) {
  EXPECT_THAT(errors_of(with("file: [a]")), ElementsAre(HasSubstr("a list is not a text")));
}

TEST_F(PipelineFileTest, RequestsStagesWhetherTheirOptionsAgree) {
  EXPECT_THAT(errors_of(with("file: x, count: 13")),
              ElementsAre("p.yaml:3:12: error: toy.everything: 13 is an unlucky count; take 12"));
}

TEST_F(PipelineFileTest, SubstitutesVariables) {
  const PipelineArguments arguments = {.input = "/data/hub.pcap", .output = "/out/"};
  EXPECT_THAT(
      errors_of("crisp: 1\n"
                "vars: {wide: 50cm, widths: [\"${wide}\", 1cm], n: 3}\n"
                "pipeline:\n"
                "  - stage: toy.everything\n"
                "    with: {file: ${output}/${n}.txt, word: ${input}, sigma: ${widths}, names: ['$${n}']}\n",
                arguments),
      IsEmpty());
  EXPECT_EQ(everything().file, "/out/3.txt");
  EXPECT_EQ(everything().word, "/data/hub.pcap");
  EXPECT_THAT(everything().sigma, ElementsAre(0.5, 0.01));
  EXPECT_THAT(everything().names, ElementsAre("${n}"));
}

TEST_F(PipelineFileTest, ReportsWhichVariableIsUnknownOrMissing) {
  EXPECT_THAT(errors_of("crisp: 1\nvars: {wide: 1, output: x, l: [1]}\n" +
                        with("file: ${input}, word: ${wied}, names: [\"${open\", \"a${l}\"]").substr(9)),
              ElementsAre(HasSubstr("p.yaml:2:17: error: vars: 'output' is set by the command line"),
                          HasSubstr("p.yaml:5:18: error: ${input} has no value; give it with -i"),
                          HasSubstr("p.yaml:5:34: error: there is no variable 'wied'; did you mean 'wide'?"),
                          HasSubstr("'${open' has no }"), HasSubstr("${l} is a list; let it stand alone")));
}

TEST_F(PipelineFileTest, ReportsThatTheEnvironmentIsNotReadAndNamesEachVariableOnce) {
  setenv("CRISP_TEST_FOLDER", "/x", 1);
  EXPECT_THAT(
      errors_of(with("file: \"${CRISP_TEST_FOLDER}/y\"")),
      ElementsAre(HasSubstr(
          "there is no variable 'CRISP_TEST_FOLDER'; environment variables are not read; declare it under vars")));
  unsetenv("CRISP_TEST_FOLDER");
  EXPECT_THAT(errors_of(with("file: \"${qqqqqqqq}\""), {.input = "a", .output = "b"}),
              ElementsAre(HasSubstr("known are input, name, output, stem")));
}

TEST_F(PipelineFileTest, StopsVariablesThatDoubleOneAnother) {
  std::string texts = "crisp: 1\nvars:\n  a0: xxxxxxxxxxxxxxxx\n";
  std::string lists = "crisp: 1\nvars:\n  a0: [1, 2]\n";
  for (int i = 1; i < 60; ++i) {
    texts += fmt::format("  a{0}: \"${{a{1}}}${{a{1}}}\"\n", i, i - 1);
    lists += fmt::format("  a{0}: [${{a{1}}}, ${{a{1}}}]\n", i, i - 1);
  }
  EXPECT_THROW(errors_of(texts), Error);
  EXPECT_THROW(errors_of(lists), Error);
}

TEST_F(PipelineFileTest, ValidatesWithoutInputAndOutput) {
  EXPECT_THAT(errors_of(with("file: ${output}/x, word: ${input}"), {.only_validate = true}), IsEmpty());
}

TEST_F(PipelineFileTest, LetsTheCommandLineGoBeforeTheFile) {
  const PipelineArguments arguments = {.set = {"toy.everything.length=7cm", "toy.everything.sigma=[1cm, 2cm]",
                                               "toy.everything.word=a: b", "n=5",
                                               "toy.everything.file=sub/x"}};
  EXPECT_THAT(
      errors_of("crisp: 1\nvars: {n: 3}\n" + with("count: ${n}, length: 5cm, file: y").substr(9), arguments),
      IsEmpty());
  EXPECT_DOUBLE_EQ(everything().length, 0.07);
  EXPECT_THAT(everything().sigma, ElementsAre(0.01, 0.02));
  EXPECT_EQ(everything().word, "a: b");
  EXPECT_EQ(everything().count, 5);
  EXPECT_EQ(everything().file, fs::current_path() / "sub/x");
}

TEST_F(PipelineFileTest, PathsOfTheFileAreRelativeToItAndThoseOfTheCommandLineToTheCurrentFolder) {
  const std::string yaml =
      "crisp: 1\nvars: {data: here, name: \"${data}/x\"}\n" + with("file: \"${name}\"").substr(9);
  EXPECT_THAT(errors_of(yaml), IsEmpty());
  EXPECT_EQ(everything().file, "/there/here/x");
  EXPECT_THAT(errors_of(yaml, {.set = {"name=there/y"}}), IsEmpty());
  EXPECT_EQ(everything().file, fs::current_path() / "there/y") << "a variable that is the path";
  EXPECT_THAT(errors_of(yaml, {.set = {"data=../there"}}), IsEmpty());
  EXPECT_EQ(everything().file, fs::current_path().parent_path() / "there/x")
      << "one that the path begins with";
}

TEST_F(PipelineFileTest, RefusesSettingsOfNoUse) {
  const PipelineArguments arguments = {.set = {"toy.evrything.count=1", "toy.everything.cuont=1",
                                               "toy.everything.count=x", "n=1", "flag", "sigma=[1m]",
                                               "toy.everything.sigma=[1"}};
  EXPECT_THAT(
      errors_of(with("file: y"), arguments),
      testing::UnorderedElementsAre(
          "--set toy.evrything.count=1: error: the pipeline has no stage with the tag 'toy.evrything'; did you mean 'toy.everything'?",
          "--set toy.everything.cuont=1: error: toy.everything: there is no option 'cuont'; did you mean 'count'?",
          HasSubstr(
              "--set toy.everything.count=x: error: toy.everything: option 'count': 'x' is not a whole number"),
          HasSubstr("--set n=1: error: the pipeline has no variable 'n'"),
          HasSubstr("the pipeline has no variable 'sigma'; did you mean 'toy.everything.sigma'?"),
          HasSubstr("--set flag: error: a setting needs a name and a value"), HasSubstr("this is not YAML")));
}

TEST_F(PipelineFileTest, ConnectsByTagsAndNumbersStagesOfOneName) {
  EXPECT_THAT(errors_of("crisp: 1\n"
                        "pipeline:\n"
                        "  - {stage: toy.count, tag: left}\n"
                        "  - {stage: toy.count}\n"
                        "  - {stage: toy.sum, inputs: left}\n"
                        "  - {stage: toy.log, inputs: [left, toy.count]}\n"
                        "  - {stage: toy.log}\n"),
              IsEmpty());
  EXPECT_THAT(pipeline_.nodes[2].feeders, ElementsAre(ElementsAre(0)));
  EXPECT_THAT(pipeline_.nodes[3].feeders, ElementsAre(ElementsAre(0, 1), IsEmpty()));
  EXPECT_EQ(pipeline_.nodes[4].tag, "toy.log-2");
}

TEST_F(PipelineFileTest, FindsMistakesOfSchemaStagesAndWiringAtOnce) {
  EXPECT_THAT(
      errors_of("crisp: 1\n"
                "pipelin: 3\n"
                "pipeline:\n"
                "  - stage: toy.sum\n"
                "  - stage: toy.cuont\n"
                "    whit: {}\n"
                "  - tag: x\n"
                "  - {stage: toy.count, tag: 'a b', inputs: {}}\n"),
      testing::UnorderedElementsAre(
          HasSubstr("p.yaml:2:1: error: pipeline: there is no key 'pipelin'; did you mean 'pipeline'?"),
          HasSubstr("p.yaml:4:12: error: toy.sum: nothing above it gives the Number"),
          HasSubstr(
              "p.yaml:5:12: error: there is no stage 'toy.cuont'; did you mean 'toy.count'? load a plugin's"),
          HasSubstr("p.yaml:6:5: error: stage: there is no key 'whit'; did you mean 'with'?"),
          HasSubstr("p.yaml:7:5: error: stage: 'stage' is missing"),
          HasSubstr("p.yaml:8:29: error: stage: 'a b' is not a tag"),
          HasSubstr("a map is not a list of tags")));
}

TEST_F(PipelineFileTest, ReadsTheRigNextToItOrTheOneOfTheCommandLine) {
  const std::string stages = "pipeline: [{stage: toy.count}]\n";
  EXPECT_THAT(
      errors_of("crisp: 1\nrig: nowhere.yaml\n" + stages),
      ElementsAre(
          "p.yaml:2:6: error: cannot read /there/nowhere.yaml: No such file or directory; check its name and its permissions"));
  const PipelineArguments arguments = {.rig = source_dir() + "/configs/rig.yaml"};
  EXPECT_THAT(errors_of("crisp: 1\nrig: nowhere.yaml\n" + stages, arguments), IsEmpty());
  EXPECT_THAT(
      errors_of(
          "crisp: 1\nrig: {crisp: 1, lasers: {only: {address: 10.0.0.1, nominal: {lambda: 0, tau: 0}}}, plate: {address: 10.0.0.2}}\n" +
          stages),
      IsEmpty());
  EXPECT_EQ(run_.rig.lasers.at(0).name, "only");
}

TEST_F(PipelineFileTest, LoadsAFileAndSortsItsErrorsByLine) {
  const fs::path file = fs::path(testing::TempDir()) / "crisp_pipeline_file_test.yaml";
  write_file(file, "crisp: 1\npipeline:\n  - stage: toy.sum\n  - stage: toy.count\n    with: {n: -1}\n");
  try {
    load_pipeline(file, {}, run_);
    FAIL() << "no error";
  } catch (const Errors& errors) {
    ASSERT_EQ(errors.all().size(), 2u);
    EXPECT_EQ(errors.all()[0].place().line, 3);
    EXPECT_EQ(errors.all()[1].place().line, 5);
  }
  write_file(file, "crisp: 1\npipeline:\n  - stage: toy.count\n");
  EXPECT_EQ(load_pipeline(file, {.output = "/out"}, run_).pipeline.nodes.size(), 1u);
  EXPECT_EQ(run_.output, "/out");
  fs::remove(file);
}

}  // namespace
}  // namespace crisp
