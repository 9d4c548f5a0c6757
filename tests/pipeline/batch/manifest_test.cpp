// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/manifest.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include <crisp/error.hpp>

#include "pipeline/batch/last_batch.hpp"
#include "pipeline/batch/manifest_line.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
using testing::ElementsAre;

std::vector<std::string> names_in(const std::filesystem::path& file, std::size_t* damaged = nullptr) {
  std::vector<std::string> names;
  const auto count =
      read_manifest(file, [&](BatchEvent&& event, std::string_view) { names.push_back(event.name); });
  if (damaged) *damaged = count;
  return names;
}

TEST(Manifest, GivesBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  const std::vector<InputFile> input = {{"a \"b\".pcap", 7, 1'700'000'000'123'456'789, "abc"}, {"c", 1, 2}};
  {
    ManifestWriter writer(folder / "m/events.jsonl");
    writer.append(BatchEventKind::start, {{"name", "a"}});
    writer.append(BatchEventKind::end, {{"name", "a"},
                                        {"status", "untrusted"},
                                        {"settings", "s1"},
                                        {"input", to_json(input)},
                                        {"exit", 3},
                                        {"results", {{"name", "not the recording's"}}}});
    writer.sync();
  }
  std::vector<BatchEvent> events;
  read_manifest(folder / "m/events.jsonl",
                [&](BatchEvent&& event, std::string_view) { events.push_back(std::move(event)); });
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, BatchEventKind::start);
  EXPECT_EQ(events[1].kind, BatchEventKind::end);
  EXPECT_EQ(events[1].name, "a");
  EXPECT_EQ(events[1].status, JobStatus::untrusted);
  EXPECT_EQ(events[1].settings, "s1");
  EXPECT_EQ(events[1].input, input);
  EXPECT_LE(events[0].time, events[1].time);
}

TEST(Manifest, ReadsTimesAsMillisecondsSinceTheEpoch) {
  // From `date -u -d 2026-11-27T08:02:59.720Z +%s%3N`.
  const auto event = parse_manifest_line(R"({"event":"start","time":"2026-11-27T08:02:59.720Z","name":"a"})");
  ASSERT_TRUE(event);
  EXPECT_EQ(event->time, 1795766579720);
  EXPECT_FALSE(parse_manifest_line(R"({"event":"start","time":"2026-13-27T08:02:59.720Z","name":"a"})"));
  EXPECT_FALSE(parse_manifest_line(R"({"event":"start","time":"yesterday","name":"a"})"));
}

TEST(Manifest, GoesOnBehindALineThatWasCutOffWhereverThatWas) {
  const test::TemporaryFolder folder;
  const auto file = folder / "events.jsonl";
  {
    ManifestWriter writer(file);
    writer.append(BatchEventKind::start, {{"name", "first"}});
    writer.append(BatchEventKind::start, {{"name", "second"}});
  }
  const std::string whole = test::bytes_of(file);
  const std::size_t first_line = whole.find('\n') + 1;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    test::put_bytes(file, whole.substr(0, size));
    const std::size_t left = size < first_line ? 0 : size < whole.size() ? 1 : 2;
    EXPECT_EQ(names_in(file).size(), left) << size;
    ManifestWriter(file).append(BatchEventKind::start, {{"name", "next"}});
    std::size_t damaged = 1;
    const auto names = names_in(file, &damaged);
    EXPECT_EQ(damaged, 0U) << size;
    ASSERT_EQ(names.size(), left + 1) << size;
    EXPECT_EQ(names.back(), "next");
  }
}

TEST(Manifest, PassesOverLinesThatAreNoEventsAndCountsThem) {
  const test::TemporaryFolder folder;
  const auto file = folder / "events.jsonl";
  ManifestWriter(file).append(BatchEventKind::start, {{"name", "a"}});
  std::ofstream(file, std::ios::app) << std::string(20, '\0') << "\n{\"event\":\"strat\"}\n[1]\n{}\n\n";
  ManifestWriter(file).append(BatchEventKind::start, {{"name", "b"}});
  std::size_t damaged = 0;
  EXPECT_THAT(names_in(file, &damaged), ElementsAre("a", "b"));
  EXPECT_EQ(damaged, 5U);
}

TEST(Manifest, KeepsNothingOfALineThatDidNotFitOnTheDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  ManifestWriter writer("/dev/full");
  EXPECT_THROW(writer.append(BatchEventKind::start, {{"name", "a"}}), Error);
}

TEST(LastBatch, IsTheOneThatBeganLastInWhicheverTask) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(last_batch(folder.path()).is_null());
  const auto put = [&](const std::string& task, const std::string& time, int jobs) {
    ManifestWriter writer(task_folder(folder.path(), task) / kManifestFile);
    std::ofstream(task_folder(folder.path(), task) / kManifestFile)
        << R"({"event":"batch","time":")" << time << R"(","jobs":)" << jobs << "}\n";
  };
  put("shard-1-of-2", "2026-01-01T00:00:02.000Z", 1);
  put("shard-2-of-2", "2026-01-01T00:00:01.000Z", 2);
  EXPECT_EQ(last_batch(folder.path())["jobs"], 1);
}

}  // namespace
}  // namespace crisp
