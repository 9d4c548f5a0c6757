// SPDX-License-Identifier: BSD-3-Clause
// `crisp batch status`, `retry` and `table`.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/pipeline/app/batch_fixture.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

TEST_F(BatchTest, StatusReportsRunningAndFailedJobsWithReasons) {
  put("a.pcap", "done");
  put("b.pcap", "fail");
  put("c.pcap", "wait");
  put("d.pcap", "done");
  const pid_t child = start(words({"--jobs", "1"}));
  wait_for_calls(3);
  const auto running = crisp({"batch", "status", path("out")});
  EXPECT_EQ(running.status, 0);
  EXPECT_THAT(running.out,
              HasSubstr("4 recordings: 1 done, 0 untrusted, 1 failed, 1 running or due, 1 not begun\n"));
  EXPECT_THAT(running.out, HasSubstr("  failed b: " + path("perform.yaml")));
  EXPECT_THAT(running.out, HasSubstr("  running c\n"));
  kill(child, SIGKILL);
  wait_for(child);
  EXPECT_EQ(nlohmann::json::parse(crisp({"batch", "status", path("out"), "--json"}).out)["counts"]["due"], 1)
      << "what was half done";
}

TEST_F(BatchTest, RetryRunsWhatFailedAsItWasRunBefore) {
  put("a.pcap", "fail");
  put("b.pcap", "fail");
  put("c.pcap", "done");
  EXPECT_EQ(batch({"--set", "toy.perform.text=!"}).status, 1);
  const auto one = crisp({"batch", "retry", path("out"), "--match", "a*"});
  EXPECT_EQ(one.status, 1);
  EXPECT_THAT(one.error, HasSubstr("1 recording to be tried again\n"));
  EXPECT_THAT(calls(), ElementsAre(Pair("a.pcap", 2), Pair("b.pcap", 1), Pair("c.pcap", 1)));
  put("b.pcap", "done");
  put("a.pcap", "done");
  EXPECT_EQ(crisp({"batch", "retry", path("out")}).status, 0);
  EXPECT_EQ(content("out/b/b.txt"), "done!\n");
}

TEST_F(BatchTest, RetryOnlyMarksOnRequest) {
  put("a.pcap", "fail");
  EXPECT_EQ(batch().status, 1);
  EXPECT_EQ(crisp({"batch", "retry", path("out"), "--mark"}).status, 0);
  EXPECT_EQ(calls()["a.pcap"], 1);
  EXPECT_THAT(batch().error, HasSubstr("due again, since a retry was requested: 1 recording (a)\n"));
  EXPECT_EQ(calls()["a.pcap"], 2);
}

TEST_F(BatchTest, TableMergesWhatShardsWroteAndCarriesTheirExitStatus) {
  for (int i = 0; i < 6; ++i) put("r" + std::to_string(i) + ".pcap", i == 3 ? "caveat" : "done");
  batch({"--shard", "1/2"});
  const auto half = crisp({"batch", "status", path("out")});
  EXPECT_THAT(half.out, HasSubstr("6 recordings: "));
  EXPECT_THAT(half.out, HasSubstr(" not begun\n"));
  batch({"--shard", "2/2"});
  const auto table = crisp({"batch", "table", path("out")});
  EXPECT_EQ(table.status, 3);
  EXPECT_EQ(std::ranges::count(table.out, '\n'), 7);
  EXPECT_EQ(table.out, content("out/table.csv"));
  EXPECT_EQ(field("r3", "status"), "untrusted");
  const auto as_json = nlohmann::json::parse(crisp({"batch", "table", path("out"), "--json"}).out);
  EXPECT_EQ(as_json["rows"].size(), 6U);
}

TEST_F(BatchTest, VerbsNameAFolderThatIsNoBatch) {
  for (const char* verb : {"status", "table", "retry"}) {
    const auto outcome = crisp({"batch", verb, path("in")});
    EXPECT_NE(outcome.status, 0) << verb;
    EXPECT_THAT(outcome.error, HasSubstr(path("in") + " is no output folder of a batch")) << verb;
  }
  EXPECT_THAT(crisp({"batch", path("perform.yaml"), "-i", path("in")}).error, HasSubstr("-o is missing"));
}

}  // namespace
}  // namespace crisp
