// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <map>
#include <thread>

#include <crisp/runner.hpp>

#include "tests/pipeline/stage/toy_stages.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class RunnerTest : public testing::Test {
 protected:
  RunnerTest() {
    toy::register_toys(registrar_);
    run_.registrar = &registrar_;
    toy::log().clear();
  }

  std::vector<NodeResult> run(const std::vector<StageSpec>& specs, const RunHooks& hooks = {}) {
    Pipeline pipeline = build_pipeline(specs, run_);
    return run_pipeline(pipeline, run_, hooks);
  }

  std::string message_of(const std::vector<StageSpec>& specs) {
    try {
      run(specs);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  static OptionValue number(int value) { return OptionScalar(std::int64_t{value}); }
  static OptionValue yes() { return OptionScalar(true); }
  static OptionValue text(const std::string& value) { return OptionScalar(value); }
  static OptionValue words(const std::vector<std::string>& list) {
    return std::vector<OptionScalar>(list.begin(), list.end());
  }

  Registrar registrar_;
  RunSettings run_;
};

TEST_F(RunnerTest, PassesEachItemThroughAllStagesBeforeTheNext) {
  run({{.stage = "toy.count", .with = {{"n", number(2)}}},
       {.stage = "toy.log", .tag = "a"},
       {.stage = "toy.log", .tag = "b"}});
  EXPECT_THAT(toy::log(), ElementsAre("number 1", "number 1", "number 2", "number 2", "count finishes",
                                      "log finishes", "log finishes"));
}

TEST_F(RunnerTest, KeepsWhatDrivesAStageUntilWhatItHoldsIsThere) {
  run({{.stage = "toy.count"}, {.stage = "toy.sum"}, {.stage = "toy.share"}, {.stage = "toy.log"}});
  EXPECT_THAT(toy::log(), ElementsAre("count finishes", "1/6", "number 16", "2/6", "number 33", "3/6",
                                      "number 50", "log finishes"));
}

TEST_F(RunnerTest, WaitsForAnOptionalInputThatAStageAboveGives) {
  run({{.stage = "toy.count", .with = {{"n", number(2)}}},
       {.stage = "toy.words", .with = {{"words", words({"aye"})}}},
       {.stage = "toy.sum"},
       {.stage = "toy.share"}});
  EXPECT_THAT(toy::log(), ElementsAre("count finishes", "1/3 aye", "2/3 aye"));
}

TEST_F(RunnerTest, GoesOnWithoutAnOptionalInputThatNeverCame) {
  run({{.stage = "toy.count", .with = {{"n", number(2)}}},
       {.stage = "toy.words", .with = {{"words", words({})}}},
       {.stage = "toy.sum"},
       {.stage = "toy.share"}});
  EXPECT_THAT(toy::log(), ElementsAre("count finishes", "1/3", "2/3"));
}

TEST_F(RunnerTest, ReplaysUpdatesOfAHeldInputInTheirOrder) {
  // Both words are given before the numbers come, as the source of words is only held: the last one is kept.
  run({{.stage = "toy.count", .with = {{"n", number(1)}}},
       {.stage = "toy.words", .with = {{"words", words({"first", "last"})}}},
       {.stage = "toy.sum"},
       {.stage = "toy.share"}});
  EXPECT_THAT(toy::log(), ElementsAre("count finishes", "1/1 last"));
}

TEST_F(RunnerTest, MergesTheStagesThatInputsNames) {
  run({{.stage = "toy.count", .tag = "low", .with = {{"n", number(1)}}},
       {.stage = "toy.count", .tag = "high", .with = {{"n", number(1)}, {"first", number(9)}}},
       {.stage = "toy.log", .inputs = {{{"low", {}}, {"high", {}}}}}});
  EXPECT_THAT(toy::log(),
              ElementsAre("number 1", "number 9", "count finishes", "count finishes", "log finishes"));
}

TEST_F(RunnerTest, CountsWhatEachStageTookAndGave) {
  const auto results = run({{.stage = "toy.count"}, {.stage = "toy.log"}});
  EXPECT_EQ(results[0].given.at("Number"), 3u);
  EXPECT_EQ(results[1].taken.at("Number"), 3u);
  EXPECT_EQ(results[1].report.counts.at("entries"), 3u);
  EXPECT_GE(results[0].seconds, 0);
}

TEST_F(RunnerTest, TurnsCaveatsOfReplacedItemsIntoWarnings) {
  const auto results = run({{.stage = "toy.count"},
                            {.stage = "toy.caveat", .tag = "first"},
                            {.stage = "toy.caveat", .tag = "second"},
                            {.stage = "toy.caveat", .tag = "last", .with = {{"lift", yes()}}}});
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_THAT(results[i].report.caveats, testing::IsEmpty());
    EXPECT_THAT(results[i].report.warnings, ElementsAre("are these numbers?; last: they add up"));
  }
}

TEST_F(RunnerTest, ReportsEachCaveatAtOnce) {
  RunHooks hooks;
  hooks.caveat = [](const std::string& tag, const std::string& caveat) {
    toy::log().push_back(tag + ": " + caveat);
  };
  run({{.stage = "toy.count", .with = {{"n", number(1)}}},
       {.stage = "toy.caveat", .tag = "early"},
       {.stage = "toy.log", .tag = "late"}},
      hooks);
  EXPECT_THAT(toy::log(),
              ElementsAre("number 1", "count finishes", "early: are these numbers?", "log finishes"));
}

TEST_F(RunnerTest, KeepsCaveatsOfItemsThatGoElsewhereToo) {
  const auto results = run({{.stage = "toy.count"},
                            {.stage = "toy.caveat", .tag = "first"},
                            {.stage = "toy.caveat", .tag = "last", .with = {{"lift", yes()}}},
                            {.stage = "toy.log", .inputs = {{{"first", {}}}}}});
  EXPECT_THAT(results[1].report.caveats, ElementsAre("are these numbers?"));
  EXPECT_THAT(results[1].report.warnings, testing::IsEmpty());
}

TEST_F(RunnerTest, GivesAStageTheCaveatsOfThoseAbove) {
  const auto heard = [&](const std::vector<StageSpec>& specs) {
    return run(specs).back().report.section.at("caveats").get<std::vector<std::string>>();
  };
  const StageSpec caveat = {.stage = "toy.caveat"};
  StageSpec lifts = caveat;
  lifts.with = {{"lift", yes()}};
  EXPECT_THAT(heard({{.stage = "toy.count"}, caveat, {.stage = "toy.sum"}, {.stage = "toy.hear"}}),
              ElementsAre("are these numbers?"));
  EXPECT_THAT(heard({{.stage = "toy.count"}, caveat, lifts, {.stage = "toy.sum"}, {.stage = "toy.hear"}}),
              testing::IsEmpty());
  const StageSpec aside = {.stage = "toy.sum", .inputs = {{{"toy.count", {}}}}};
  EXPECT_THAT(heard({{.stage = "toy.count"}, caveat, aside, {.stage = "toy.hear"}}), testing::IsEmpty());
}

TEST_F(RunnerTest, ReportsTheStageThatThrewAndNotTheOneThatFedIt) {
  const std::vector<StageSpec> specs = {{.stage = "toy.count"}, {.stage = "toy.throw", .tag = "culprit"}};
  EXPECT_EQ(message_of(specs), "culprit: it saw a three; avoid threes");
}

TEST_F(RunnerTest, ReportsTheStagesResultsWhenOneThrew) {
  std::vector<NodeResult> done;
  const RunHooks hooks{.failed = [&](std::vector<NodeResult> until_then) { done = std::move(until_then); }};
  EXPECT_THROW(run({{.stage = "toy.count"}, {.stage = "toy.log"}, {.stage = "toy.throw"}}, hooks), Error);
  ASSERT_EQ(done.size(), 3U);
  EXPECT_EQ(done[1].report.counts.at("entries"), 3U);
  EXPECT_EQ(done[2].given.at("Number"), 2U);
}

TEST_F(RunnerTest, TurnsAnyExceptionIntoAnErrorWithThePlaceOfTheStage) {
  std::vector<StageSpec> specs = {{.stage = "toy.count"}, {.stage = "toy.throw"}};
  specs[1].place = {"p.yaml", 7, 5};
  specs[1].with = {{"how", text("standard")}};
  EXPECT_EQ(
      message_of(specs),
      "p.yaml:7:5: error: toy.throw: three: an error of this program; please report it with the command and its input");
  specs[1].with = {{"how", text("memory")}};
  EXPECT_THAT(message_of(specs), HasSubstr("toy.throw: the memory is exhausted"));
  specs[1].with = {{"how", text("undeclared")}};
  EXPECT_THAT(message_of(specs), HasSubstr("it gives Word, which it does not declare"));
}

TEST_F(RunnerTest, ReportsAMissingInputOfAStage) {
  const OptionValue yes = OptionScalar(true);
  EXPECT_THAT(
      message_of(
          {{.stage = "toy.count"}, {.stage = "toy.sum", .with = {{"silent", yes}}}, {.stage = "toy.share"}}),
      HasSubstr("toy.share: it waited for a Sum, but the stages above gave none"));
}

TEST_F(RunnerTest, StopsWithoutFinishingOnRequest) {
  std::atomic<bool> stop = true;
  const std::vector<StageSpec> specs = {{.stage = "toy.count"}, {.stage = "toy.log"}};
  EXPECT_THROW(run(specs, {.stop = &stop}), Interrupted);
  EXPECT_TRUE(toy::log().empty());
}

TEST_F(RunnerTest, FinishesWhenAnEndlessSourceIsStopped) {
  std::atomic<bool> stop = false;
  std::thread reported([&] { stop = true; });
  const auto results = run({{.stage = "toy.endless"}, {.stage = "toy.log"}}, {.stop = &stop});
  reported.join();
  EXPECT_THAT(toy::log().back(), "log finishes");
  EXPECT_EQ(results.at(0).given, results.at(1).taken) << "all that was given was taken";
}

TEST_F(RunnerTest, PullsEndlessSourcesAtTheSameTimeAndGivesTheirItemsInTurn) {
  std::atomic<bool> stop = false;
  std::map<std::string, int> given;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  RunHooks hooks{.stop = &stop};
  hooks.given = [&](const std::string& tag, const Item& item) {
    EXPECT_EQ(item.as<toy::Number>()->value, ++given[tag]) << "each source's in their order";
    const bool both = given["a"] > 100 && given["b"] > 100;
    if (both || std::chrono::steady_clock::now() > deadline) stop = true;
  };
  const auto results = run({{.stage = "toy.endless", .tag = "a"},
                            {.stage = "toy.endless", .tag = "b"},
                            {.stage = "toy.log", .inputs = {{{"a"}, {"b"}}}}},
                           hooks);
  EXPECT_GT(given["a"], 100);
  EXPECT_GT(given["b"], 100);
  EXPECT_EQ(results.at(2).taken.at("Number"),
            results.at(0).given.at("Number") + results.at(1).given.at("Number"));
  EXPECT_EQ(toy::log().back(), "log finishes");
}

TEST_F(RunnerTest, EndsAllEndlessSourcesWhenAStageBelowOneFails) {
  EXPECT_THAT(message_of({{.stage = "toy.endless", .tag = "a"},
                          {.stage = "toy.endless", .tag = "b"},
                          {.stage = "toy.throw", .inputs = {{{"b"}}}}}),
              HasSubstr("toy.throw"));
}

TEST_F(RunnerTest, PassesOnAStagesStatus) {
  std::vector<std::string> reported;
  RunHooks hooks;
  hooks.status = [&](const std::string& tag, const StageStatus& status) {
    reported.push_back(tag + " " + status.line + " " + status.gauges.at(0).name);
  };
  run({{.stage = "toy.status"}}, hooks);
  EXPECT_THAT(reported, ElementsAre("toy.status is well health"));
}

}  // namespace
}  // namespace crisp
