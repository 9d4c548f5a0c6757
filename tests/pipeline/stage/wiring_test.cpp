// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/wiring.hpp"

#include <gmock/gmock.h>

#include "tests/pipeline/stage/toy_stages.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class WiringTest : public testing::Test {
 protected:
  WiringTest() {
    toy::register_toys(registrar_);
    run_.registrar = &registrar_;
  }

  std::vector<std::string> errors_of(const std::vector<StageSpec>& specs) {
    std::vector<Error> errors;
    build_pipeline(specs, run_, errors);
    std::vector<std::string> texts;
    for (const auto& error : errors) texts.emplace_back(error.what());
    return texts;
  }

  Registrar registrar_;
  RunSettings run_;
};

TEST_F(WiringTest, FeedsAnInputFromTheNearestStageAboveThatGivesItsKind) {
  const Pipeline pipeline = build_pipeline({{.stage = "toy.count", .tag = "far"},
                                            {.stage = "toy.count", .tag = "near"},
                                            {.stage = "toy.words"},
                                            {.stage = "toy.sum"}},
                                           run_);
  EXPECT_THAT(pipeline.nodes[3].feeders, ElementsAre(ElementsAre(1)));
}

TEST_F(WiringTest, NamesTheStagesThatGiveWhatIsMissing) {
  EXPECT_THAT(
      errors_of({{.stage = "toy.sum"}}),
      ElementsAre(
          "toy.sum: nothing above it gives the Number that it takes; put one of these above it: toy.caveat, toy.count, toy.endless, toy.share, toy.throw"));
}

TEST_F(WiringTest, PointsAtAStageAboveThatInputsLeavesOut) {
  EXPECT_THAT(errors_of({{.stage = "toy.count"},
                         {.stage = "toy.sum"},
                         {.stage = "toy.share", .inputs = {{{"toy.count", {}}}}}}),
              ElementsAre(HasSubstr(
                  "toy.share: nothing above it gives the Sum that it takes; add 'toy.sum' to its inputs")));
}

TEST_F(WiringTest, SuggestsTheNearestStageAndTag) {
  EXPECT_THAT(
      errors_of({{.stage = "toy.cuont"}}),
      ElementsAre(
          "there is no stage 'toy.cuont'; did you mean 'toy.count'? load a plugin's with --plugin FILE"));
  EXPECT_THAT(
      errors_of({{.stage = "toy.count", .tag = "left"},
                 {.stage = "toy.sum", .inputs = {{{"lfet", {"p.yaml", 3, 9}}}}}}),
      ElementsAre("p.yaml:3:9: error: toy.sum: there is no stage with the tag 'lfet'; did you mean 'left'?"));
}

TEST_F(WiringTest, KnowsAStageByTheLastPartOfItsName) {
  for (const char* name : {"throw", "throwing"}) {
    EXPECT_THAT(errors_of({{.stage = name}}),
                ElementsAre(HasSubstr("; did you mean 'toy.throw'? load a plugin's")));
  }
}

TEST_F(WiringTest, RemindsOfPluginsWhereNoStageIsNear) {
  EXPECT_THAT(
      errors_of({{.stage = "example.near"}}),
      ElementsAre(
          "there is no stage 'example.near'; crisp stages lists them; load a plugin's with --plugin FILE"));
}

TEST_F(WiringTest, RefusesInputsFromBelowAndInputsOfNoUse) {
  EXPECT_THAT(errors_of({{.stage = "toy.log", .inputs = {{{"toy.count", {}}}}}, {.stage = "toy.count"}}),
              ElementsAre(HasSubstr("its input 'toy.count' is not above it")));
  EXPECT_THAT(
      errors_of({{.stage = "toy.count"},
                 {.stage = "toy.words"},
                 {.stage = "toy.sum", .inputs = {{{"toy.count", {}}, {"toy.words", {}}}}}}),
      ElementsAre(
          "toy.sum: 'toy.words' gives no item that toy.sum takes; it gives Word, and toy.sum takes Number"));
}

TEST_F(WiringTest, RefusesATagThatIsUsedTwice) {
  EXPECT_THAT(errors_of({{.stage = "toy.count", .tag = "a", .place = {"p.yaml", 2, 3}},
                         {.stage = "toy.count", .tag = "a", .place = {"p.yaml", 4, 3}}}),
              ElementsAre("p.yaml:4:3: error: the tag 'a' is used twice; the other is at p.yaml:2:3"));
}

TEST_F(WiringTest, DoesNotBlameStagesForAMisspeltOneAboveThem) {
  EXPECT_THAT(errors_of({{.stage = "toy.nothing_alike_at_all"}, {.stage = "toy.sum"}}),
              ElementsAre(HasSubstr("there is no stage 'toy.nothing_alike_at_all'")));
}

TEST_F(WiringTest, WarnsOfAStageBelowThoseThatItWasToFeed) {
  const auto warnings_of = [&](const std::vector<StageSpec>& specs) {
    std::vector<std::string> texts;
    for (const auto& warning : build_pipeline(specs, run_).warnings)
      texts.push_back(to_string(warning.place) + " " + warning.text);
    return texts;
  };
  const StageSpec count{.stage = "toy.count"};
  const StageSpec filter{.stage = "toy.throw", .place = {"p.yaml", 5, 3}};  // Number to Number
  const StageSpec sum{.stage = "toy.sum"};
  EXPECT_THAT(
      warnings_of({count, sum, filter}),
      ElementsAre(
          "p.yaml:5:3 toy.throw: no stage below takes the items of toy.throw; move it above toy.sum, which does"));
  EXPECT_THAT(warnings_of({count, filter, sum}), IsEmpty());
  EXPECT_THAT(warnings_of({count, sum, filter, {.stage = "toy.log"}}), IsEmpty());
  EXPECT_THAT(warnings_of({count, filter}), IsEmpty()) << "what it gives, nothing would take";
  EXPECT_THAT(warnings_of({count, filter, {.stage = "toy.throw", .tag = "last"}}), IsEmpty())
      << "it takes what it gives from the one above it";
}

TEST_F(WiringTest, FindsAllMistakesAtOnce) {
  EXPECT_THAT(
      errors_of({{.stage = "toy.sum"},
                 {.stage = "toy.count", .with = {{"n", OptionScalar(std::int64_t{-1})}}},
                 {.stage = "toy.throw", .with = {{"how", OptionScalar(std::string("loudly"))}}}}),
      ElementsAre(
          HasSubstr("option 'n' -1 is out of range; expected is a whole number, 0 to 1000"),
          HasSubstr(
              "option 'how' 'loudly' is not one of its names; expected is one of error, standard, memory, undeclared"),
          HasSubstr("nothing above it gives the Number")));
}

}  // namespace
}  // namespace crisp
