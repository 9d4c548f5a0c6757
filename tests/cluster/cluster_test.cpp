// SPDX-License-Identifier: BSD-3-Clause
// `crisp cluster submit` on Slurm itself, one of whose nodes dies in the middle.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "tests/cluster/slurm.hpp"
#include "tests/pipeline/app/program_fixture.hpp"
#include "tests/support/source_dir.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

constexpr int kCaptures = 60;
constexpr int kTasks = 6;

class ClusterTest : public ProgramTest {
 protected:
  void SetUp() override {
    const std::string missing = test::Slurm::missing();
    if (!missing.empty()) GTEST_SKIP() << "not installed: " << missing << " (packages slurm-wlm and munge)";
    write_file(folder_ / "assemble.yaml",
               "crisp: 1\npipeline:\n"
               "  - {stage: calibrate.load, with: {file: " +
                   path("made/truth.yaml") +
                   "}}\n"
                   "  - {stage: grabber.capture, with: {file: \"${input}\"}}\n"
                   "  - stage: clock.convex_hull\n"
                   "  - stage: assemble.deskew\n"
                   "  - {stage: write.pcd, with: {file: \"${output}/cloud.pcd\", format: binary}}\n");
    for (int i = 1; i <= kCaptures; ++i) make_capture(i);
  }

  /// Captures of a scanner that is a little different each time.
  void make_capture(int seed) {
    const auto simulate = (fs::path(source_dir()) / "configs/simulate.yaml").string();
    ASSERT_EQ(crisp({"run", simulate, "-o", path("made"), "--seed", std::to_string(seed), "--set",
                     "grabber.simulate.duration=1s", "--threads", "1", "--quiet"})
                  .status,
              0);
    const auto to =
        folder_ / "captures" / ("site" + std::to_string(seed % 3)) / (std::to_string(seed) + ".pcap");
    fs::create_directories(to.parent_path());
    fs::rename(folder_ / "made/hub.pcap", to);
  }

  /// The events of a kind in a task's manifest; of all tasks if none is named.
  std::vector<Json> events(const std::string& kind, const std::string& task = {}) const {
    std::vector<Json> found;
    std::error_code not_yet;
    for (const auto& entry : fs::directory_iterator(folder_ / "cluster/manifest", not_yet)) {
      if (!task.empty() && entry.path().filename() != task) continue;
      std::ifstream manifest(entry.path() / "events.jsonl");
      for (std::string line; std::getline(manifest, line) && !manifest.eof();) {
        auto event = Json::parse(line);
        if (event["event"] == kind) found.push_back(std::move(event));
      }
    }
    return found;
  }

  static std::string name_of_task(const std::string& number) {
    return "shard-" + number + "-of-" + std::to_string(kTasks);
  }

  /// Stops the batch of a task that has done some of its recordings, and not all.
  /// @return a process of that task; nothing if there is no such task now
  std::optional<pid_t> hold_a_task(const test::Slurm& slurm) const {
    for (int number = 1; number <= kTasks; ++number) {
      const std::string task = name_of_task(std::to_string(number));
      if (events("end", task).empty()) continue;
      const auto processes = slurm.processes_with("SLURM_ARRAY_TASK_ID", std::to_string(number));
      for (const pid_t process : processes) kill(process, SIGSTOP);
      const auto begun = events("batch", task);
      if (!processes.empty() && events("end", task).size() < begun.front()["due"]) return processes.front();
      for (const pid_t process : processes) kill(process, SIGCONT);
    }
    return std::nullopt;
  }

  /// Kills the node of a task that is in the middle of its work.
  /// @return the task's number in the array; empty if no task came so far in two minutes
  std::string kill_a_node(test::Slurm& slurm) const {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (std::chrono::steady_clock::now() < give_up) {
      const auto process = hold_a_task(slurm);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (!process) continue;
      std::string task = test::variable_of(*process, "SLURM_ARRAY_TASK_ID");
      slurm.kill_node(test::variable_of(*process, "SLURMD_NODENAME"));
      return task;
    }
    return {};
  }

  /// All files of a batch's results, without its manifests, and without durations.
  std::map<std::string, std::string> results(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / name)) {
      const std::string file = entry.path().lexically_relative(folder_ / name).string();
      if (entry.is_directory() || file.starts_with("manifest/")) continue;
      // Its command, and the digest of a table with durations, differ by design.
      if (file == "report.html.provenance.json") continue;
      files[file] = without_times(entry.path(), name);
    }
    return files;
  }

  std::string without_times(const fs::path& file, const std::string& folder) const {
    std::string text = test::bytes_of(file);
    if (file.extension() == ".csv") return without_columns(text);
    if (file.extension() == ".html")
      text = data_of_page(text);
    else if (file.extension() != ".json")
      return text;
    auto parsed = Json::parse(text);
    remove_times(parsed);
    text = parsed.dump(1);
    const std::string where = path(folder);
    for (auto at = text.find(where); at != std::string::npos; at = text.find(where))
      text.replace(at, where.size(), "");
    return text;
  }

  /// The JSON that a report draws. Its title is the folder's name.
  static std::string data_of_page(const std::string& page) {
    const std::string begin = R"(id="report-data">)";
    const auto from = page.find(begin);
    if (from == std::string::npos) return {};
    const auto at = from + begin.size();
    auto data = Json::parse(page.substr(at, page.find("</script>", at) - at));
    data.erase("title");
    return data.dump();
  }

  static bool is_time(const std::string& key) {
    static const std::set<std::string> kKeys = {"started", "seconds",     "ended",
                                                "written", "cpu_seconds", "memory"};
    return kKeys.contains(key);
  }

  static void remove_times(Json& value) {
    if (value.is_object()) {
      for (auto at = value.begin(); at != value.end();)
        at = is_time(at.key()) ? value.erase(at) : std::next(at);
    }
    if (!value.is_structured()) return;
    for (auto& inner : value) remove_times(inner);
  }

  static std::string without_columns(const std::string& table) {
    std::istringstream lines(table);
    std::vector<std::string> names;
    std::string text;
    for (std::string line; std::getline(lines, line); text += "\n") {
      std::istringstream fields(line);
      std::size_t column = 0;
      for (std::string field; std::getline(fields, field, ','); ++column) {
        if (names.size() == column) names.push_back(field);
        if (!is_time(names[column])) text += field + ",";
      }
    }
    return text;
  }
};

TEST_F(ClusterTest, GivesWhatOneMachineGivesThoughANodeDiesInTheMiddle) {
  const std::vector<std::string> batch = {path("assemble.yaml"), "-i", path("captures"), "-o"};
  std::vector<std::string> alone = {"batch"};
  alone.insert(alone.end(), batch.begin(), batch.end());
  alone.push_back(path("alone"));
  ASSERT_EQ(crisp(alone).status, 0) << content("stderr");

  test::Slurm slurm(folder_ / "slurm");
  std::vector<std::string> submit = {"cluster", "submit"};
  submit.insert(submit.end(), batch.begin(), batch.end());
  submit.insert(submit.end(), {path("cluster"), "--tasks", std::to_string(kTasks)});
  const auto submitted = crisp(submit);
  ASSERT_EQ(submitted.status, 0) << submitted.error;
  ASSERT_THAT(submitted.out, HasSubstr("job 2: the table, after them\n"));
  const std::string task = kill_a_node(slurm);
  EXPECT_NE(task, "");
  EXPECT_EQ(slurm.wait_for_job("2"), "0:0") << "the merge job has the exit status of the whole batch";

  EXPECT_EQ(events("batch", name_of_task(task)).size(), 2U) << "the task began again";
  std::map<std::string, int> done;
  for (const auto& event : events("end")) ++done[event["name"]];
  EXPECT_EQ(done.size(), static_cast<std::size_t>(kCaptures));
  for (const auto& [name, times] : done) EXPECT_EQ(times, 1) << name << " is done more than once";

  const auto expected = results("alone");
  const auto found = results("cluster");
  EXPECT_EQ(expected.size(), found.size());
  EXPECT_GE(expected.size(), 3U * kCaptures + 2);
  for (const auto& [file, text] : expected) {
    ASSERT_TRUE(found.contains(file)) << file;
    EXPECT_TRUE(found.at(file) == text) << file << " differs";
  }
}

}  // namespace
}  // namespace crisp
