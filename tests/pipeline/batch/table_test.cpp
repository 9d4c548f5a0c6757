// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/table.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include <crisp/error.hpp>

#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
namespace fs = std::filesystem;

void put_lines(const fs::path& output, const std::string& task, const std::string& lines) {
  fs::create_directories(task_folder(output, task));
  std::ofstream(task_folder(output, task) / kManifestFile) << lines;
}

template <class Print>
std::string printed(Print print) {
  std::string text;
  print([&](std::string_view piece) { text += piece; });
  return text;
}

constexpr const char* kBatch =
    R"({"event":"batch","time":"2026-01-01T00:00:00.000Z","settings":"s","crisp":"1","pipeline":"p","recordings":3})"
    "\n";

TEST(Table, HasARowARecordingWithItsLastResults) {
  const test::TemporaryFolder folder;
  put_lines(
      folder.path(), "batch",
      std::string(kBatch) +
          R"({"event":"end","time":"2026-01-01T00:00:01.000Z","name":"a","status":"failed","settings":"s","exit":1,"results":{"error":"x, \"y\""}})"
          "\n"
          R"({"event":"end","time":"2026-01-01T00:00:02.000Z","name":"b","status":"failed","settings":"s","exit":1,"results":{"error":"old"}})"
          "\n");
  put_lines(
      folder.path(), "shard-1-of-2",
      R"({"event":"end","time":"2026-01-01T00:00:03.000Z","name":"b","status":"done","settings":"s","input":[{"file":"b","bytes":5,"mtime":1}],"exit":0,"signal":0,"seconds":1.5,"cpu":1.25,"memory":1000,"results":{"begin":7.5,"points":12,"quality":{"chi2":0.5},"parameters":{"l.tau":{"value":0.25,"unit":"m","std_error":0.125},"l.eta":{"value":null,"unit":"s"}},"causes":[{"cause":"mirror.cone","scope":"l"}]}})"
      "\n");
  const auto rows = read_rows(folder.path());
  EXPECT_EQ(rows.recordings, 3U);
  EXPECT_EQ(rows.count("done"), 1U);
  EXPECT_EQ(
      printed([&](const TextSink& sink) { print_csv(rows, sink); }),
      "name,status,reasons,ended,seconds,cpu_seconds,memory,input_bytes,begin,points,causes,stands_out,chi2,l.eta,l.eta.std_error,l.tau,l.tau.std_error\n"
      "a,failed,\"x, \"\"y\"\"\",2026-01-01T00:00:01.000Z,0,0,0,0,,,,,,,,,\n"
      "b,done,,2026-01-01T00:00:03.000Z,1.5,1.25,1000,5,7.5,12,mirror.cone of l,,0.5,,,0.25,0.125\n");
  const auto json =
      nlohmann::json::parse(printed([&](const TextSink& sink) { print_json(rows, head_json(rows), sink); }));
  EXPECT_EQ(json["rows"][1]["parameters"]["l.tau"]["std_error"], 0.125);
  EXPECT_EQ(json["counts"]["failed"], 1);
}

TEST(Table, CountsAsDueWhatIsOfOtherSettingsOrHalfDone) {
  const test::TemporaryFolder folder;
  put_lines(
      folder.path(), "batch",
      std::string(kBatch) +
          R"({"event":"end","time":"2026-01-01T00:00:01.000Z","name":"a","status":"done","settings":"other","exit":0})"
          "\n"
          R"({"event":"start","time":"2026-01-01T00:00:02.000Z","name":"b"})"
          "\n");
  const auto rows = read_rows(folder.path());
  EXPECT_EQ(rows.count("due"), 2U);
  EXPECT_EQ(rows.rows[0].reasons.front(), "it was processed with other settings");
  EXPECT_EQ(rows.rows[1].reasons.front(), "it was incomplete when its batch ended");
}

TEST(Table, PassesOverAnEndWhoseResultsAreDamaged) {
  const test::TemporaryFolder folder;
  put_lines(
      folder.path(), "batch",
      std::string(kBatch) +
          R"({"event":"end","time":"2026-01-01T00:00:01.000Z","name":"a","status":"done","settings":"s","exit":0,"resu)"
          "\n");
  EXPECT_EQ(read_rows(folder.path()).damaged_lines, 1U);
  EXPECT_THROW(read_rows(folder / "nowhere"), Error);
}

}  // namespace
}  // namespace crisp
