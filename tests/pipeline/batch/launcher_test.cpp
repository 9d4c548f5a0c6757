// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/launcher.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
using testing::HasSubstr;

/// Does what the job's name requests.
int perform(const Job& job) {
  if (job.name == "abort") std::abort();
  if (job.name == "throw") throw std::runtime_error("a requested exception");
  if (job.name == "hang" || job.name == "fork") {
    if (job.name == "fork" && fork() == 0) pause();
    std::ofstream(job.output) << getpid() << std::endl;
    while (job.name == "hang") pause();
  }
  if (job.name == "memory") {
    const std::vector<char> large(200 << 20, 'x');
    std::ofstream("/dev/null").write(large.data(), 1);  // so that no compiler leaves it out
  }
  if (job.name == "loud") {
    for (int i = 0; i < 10000; ++i) std::cerr << "line " << i << "\n";
  }
  return job.name == "three" ? 3 : 0;
}

JobEnd end_of(JobLauncher& launcher, const std::string& name) {
  launcher.start({.id = 1, .name = name, .input = "in", .output = "out"});
  std::optional<JobEnd> end;
  while (!end) end = launcher.wait(std::chrono::milliseconds(1000));
  return *end;
}

TEST(JobLauncher, ReportsHowAJobEnded) {
  JobLauncher launcher(perform);
  EXPECT_EQ(end_of(launcher, "zero").exit_status, 0);
  EXPECT_EQ(end_of(launcher, "three").exit_status, 3);
  EXPECT_EQ(end_of(launcher, "abort").signal, SIGABRT);
  const auto threw = end_of(launcher, "throw");
  EXPECT_EQ(threw.exit_status, 1);
  EXPECT_EQ(
      threw.error,
      "error: a requested exception: an error of this program; please report it with the command and its input\n");
}

TEST(JobLauncher, KeepsTheEndOfWhatAJobPrints) {
  JobLauncher launcher(perform);
  const auto end = end_of(launcher, "loud");
  EXPECT_THAT(end.error, testing::StartsWith("line "));
  EXPECT_THAT(end.error, testing::EndsWith("line 9999\n"));
  EXPECT_LE(end.error.size(), 4096U);
}

TEST(JobLauncher, MeasuresTheMemoryOfTheJobAndNotThatOfTheBatch) {
  JobLauncher launcher(perform);
  const std::vector<char> own(400 << 20, 'x');
  constexpr std::uint64_t kMegabyte = 1 << 20;
  EXPECT_LT(end_of(launcher, "zero").memory, 150 * kMegabyte);
  const auto large = end_of(launcher, "memory").memory;
  EXPECT_GT(large, 200 * kMegabyte);
  EXPECT_LT(large, 350 * kMegabyte);
  EXPECT_EQ(own.back(), 'x');
}

/// Waits until the file holds a whole line, a process.
pid_t process_in(const std::filesystem::path& file) {
  std::string line;
  while (!line.ends_with('\n')) {
    std::this_thread::yield();
    line = test::bytes_of(file);
  }
  return std::stoi(line);
}

void wait_until_gone(pid_t process) {
  while (kill(process, 0) == 0) std::this_thread::yield();
}

TEST(JobLauncher, SendsSignalsToAJobAlone) {
  const test::TemporaryFolder folder;
  JobLauncher launcher(perform);
  launcher.start({.id = 1, .name = "hang", .output = folder / "one"});
  launcher.start({.id = 2, .name = "hang", .output = folder / "two"});
  process_in(folder / "one");
  process_in(folder / "two");
  launcher.signal(2, SIGTERM);
  std::optional<JobEnd> end;
  while (!end) end = launcher.wait(std::chrono::milliseconds(1000));
  EXPECT_EQ(end->id, 2U);
  EXPECT_EQ(end->signal, SIGTERM);
}

TEST(JobLauncher, KillsWhatAJobLeavesRunning) {
  const test::TemporaryFolder folder;
  JobLauncher launcher(perform);
  launcher.start({.id = 1, .name = "fork", .output = folder / "leader"});
  const pid_t group = process_in(folder / "leader");
  while (!launcher.wait(std::chrono::milliseconds(1000))) continue;
  while (kill(-group, 0) == 0) std::this_thread::yield();
}

TEST(JobLauncher, KillsItsJobsWhenItGoesInWhicheverWay) {
  const test::TemporaryFolder folder;
  {
    JobLauncher launcher(perform);
    launcher.start({.id = 1, .name = "hang", .output = folder / "one"});
    process_in(folder / "one");
  }
  wait_until_gone(process_in(folder / "one"));
  const pid_t batch = fork();
  if (batch == 0) {
    JobLauncher launcher(perform);
    launcher.start({.id = 1, .name = "hang", .output = folder / "two"});
    pause();
  }
  const pid_t job = process_in(folder / "two");
  kill(batch, SIGKILL);
  waitpid(batch, nullptr, 0);
  wait_until_gone(job);
}

}  // namespace
}  // namespace crisp
