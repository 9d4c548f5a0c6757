// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/pipeline.hpp>

#include "pipeline/stage/pipeline_plan.hpp"
#include "pipeline/stage/reference.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using namespace crisp::stage;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Has options in groups of one and of two levels.
class GroupedStage final : public Stage {
 public:
  static void describe(StageDescription<GroupedStage>& d) {
    d.name("toy.grouped").summary("has options in groups");
    d.option("seed", &GroupedStage::seed, "seed");
    d.group("motion", "how it moves");
    d.option("motion.rate", &GroupedStage::rate, "rate").unit("Hz").range(0, 10);
    d.option("motion.steps", &GroupedStage::steps, "steps");
    d.group("links.plate", "the plate's link");
    d.option("links.plate.delay", &GroupedStage::delay, "delay").unit("s");
  }
  void process(const Inputs&, Outputs&, Context&) override {}

  int seed = 1;
  double rate = 2;
  std::vector<int> steps;
  double delay = 0.5;
};

class GroupsOfOptions : public testing::Test {
 protected:
  GroupsOfOptions() {
    registrar_.stage<GroupedStage>();
    run_.registrar = &registrar_;
  }

  /// The errors of a stage with these options in a file, and these settings.
  std::vector<std::string> errors_of(const std::string& options, const std::vector<std::string>& set = {}) {
    std::vector<Error> errors;
    const std::string text =
        "crisp: 1\nvars: {speed: 3Hz, moves: {rate: 4Hz}}\npipeline:\n"
        "  - stage: toy.grouped\n    with: {" +
        options + "}\n";
    const auto plan =
        parse_plan(parse_yaml(text, "p.yaml"), "/there", {.set = set}, registrar_.stages(), errors);
    pipeline_ = build_pipeline(plan.stages, run_, errors);
    std::vector<std::string> texts;
    for (const auto& error : errors) texts.emplace_back(error.what());
    return texts;
  }

  const GroupedStage& stage() const {
    return dynamic_cast<const GroupedStage&>(*pipeline_.nodes.at(0).stage);
  }

  Registrar registrar_;
  RunSettings run_;
  Pipeline pipeline_;
};

TEST_F(GroupsOfOptions, AreMapsOfAFileAtAnyDepth) {
  EXPECT_THAT(errors_of("seed: 7, motion: {rate: 5Hz, steps: [1, 2]}, links: {plate: {delay: 20ms}}"),
              IsEmpty());
  EXPECT_EQ(stage().seed, 7);
  EXPECT_EQ(stage().rate, 5);
  EXPECT_THAT(stage().steps, ElementsAre(1, 2));
  EXPECT_EQ(stage().delay, 0.02);
}

TEST_F(GroupsOfOptions, KeepTheDefaultsOfWhatTheyDoNotGive) {
  EXPECT_THAT(errors_of("motion: {steps: 3}, links:"), IsEmpty());
  EXPECT_EQ(stage().rate, 2);
  EXPECT_EQ(stage().delay, 0.5);
}

TEST_F(GroupsOfOptions, CanBeAVariableOrHoldOne) {
  EXPECT_THAT(errors_of("motion: {rate: '${speed}'}"), IsEmpty());
  EXPECT_EQ(stage().rate, 3);
  EXPECT_THAT(errors_of("motion: '${moves}'"), IsEmpty());
  EXPECT_EQ(stage().rate, 4);
}

TEST_F(GroupsOfOptions, AreSetFromTheCommandLineOneByOneOrAsAMap) {
  EXPECT_THAT(errors_of("motion: {rate: 5Hz}",
                        {"toy.grouped.links.plate.delay=3ms", "toy.grouped.motion={rate: 6Hz, steps: [4]}"}),
              IsEmpty());
  EXPECT_EQ(stage().delay, 0.003);
  EXPECT_EQ(stage().rate, 6);
  EXPECT_THAT(stage().steps, ElementsAre(4));
}

TEST_F(GroupsOfOptions, ReportWhatIsUnknownOrWrongInThemAtItsPlace) {
  EXPECT_THAT(
      errors_of("motion: {rte: 5Hz, rate: 99Hz}, moton: {}, delay: 3s, links: fast"),
      ElementsAre(
          "p.yaml:5:21: error: toy.grouped: there is no option 'motion.rte'; did you mean 'motion.rate'?",
          HasSubstr("p.yaml:5:37: error: toy.grouped: option 'motion.rate': 99Hz is out of range"),
          HasSubstr("there is no option 'moton'; did you mean 'motion'?"),
          HasSubstr("there is no option 'delay'; did you mean 'links.plate.delay'?"),
          HasSubstr(
              "'links' is a group of options, and its value is no map; write links: {OPTION: VALUE}; crisp stages toy.grouped lists them")));
  EXPECT_THAT(errors_of("", {"toy.grouped.motion.rte=5Hz", "motion.rate=1Hz", "toy.grouped.links=fast"}),
              ElementsAre(HasSubstr("did you mean 'motion.rate'?"),
                          HasSubstr("did you mean 'toy.grouped.motion.rate'?"),
                          HasSubstr("'links' is a group of options")));
}

TEST_F(GroupsOfOptions, AreMapsInTheEffectiveOptionsAndInTheSchema) {
  ASSERT_THAT(errors_of("motion: {rate: 5Hz}"), IsEmpty());
  const auto options = effective_options(pipeline_.nodes[0]);
  EXPECT_EQ(options.dump(), R"({"seed":1,"motion":{"rate":5.0,"steps":[]},"links":{"plate":{"delay":0.5}}})");
  const auto schema = pipeline_schema(registrar_.stages());
  const auto& with = schema["properties"]["pipeline"]["items"]["anyOf"][0]["properties"]["with"];
  const auto& motion = with["properties"]["motion"];
  EXPECT_EQ(motion["description"], "how it moves");
  EXPECT_EQ(motion["additionalProperties"], false);
  EXPECT_EQ(motion["properties"]["rate"]["default"], 2.0);
  EXPECT_TRUE(with["properties"]["links"]["properties"]["plate"]["properties"].contains("delay"));
}

TEST_F(GroupsOfOptions, HaveTablesOfTheirOwnInTheReference) {
  const std::string page = stage_markdown(*registrar_.stages().find("toy.grouped"));
  EXPECT_THAT(page, HasSubstr("| `seed` | a whole number"));
  EXPECT_THAT(page, HasSubstr("\n## motion\n\nHow it moves, written as `motion: {rate: …}`.\n"));
  EXPECT_THAT(page,
              HasSubstr("\n## links.plate\n\nThe plate's link, written as `links: {plate: {delay: …}}`.\n"));
  const std::string text = stage_text(*registrar_.stages().find("toy.grouped"));
  EXPECT_THAT(text, HasSubstr("\nmotion: {rate: …} (how it moves):\n  rate "));
}

}  // namespace
}  // namespace crisp
