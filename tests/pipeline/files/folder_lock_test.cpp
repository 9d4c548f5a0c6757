// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/folder_lock.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <functional>
#include <iterator>
#include <optional>
#include <thread>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/files/lock_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
namespace fs = std::filesystem;
using std::chrono::hours;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// Runs `work` in a process of its own, which ends without running any destructor, as one that is killed.
pid_t start_process(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  return child;
}

int status_of_ended(pid_t child) {
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string refusal_in(const fs::path& folder, const FolderLockSettings& settings = {}) {
  try {
    const FolderLock lock(folder, settings);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

/// What a process that was killed leaves in the folder, and its process number.
pid_t leave_lock_behind(const fs::path& folder) {
  const pid_t child = start_process([&] {
    new FolderLock(folder);  // for its process to end without releasing it
    return 0;
  });
  EXPECT_EQ(status_of_ended(child), 0);
  return child;
}

std::ptrdiff_t entries_of(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

fs::path only_entry_of(const fs::path& folder) {
  EXPECT_EQ(entries_of(folder), 1);
  return fs::directory_iterator(folder)->path();
}

/// A lock of a process on another machine, last renewed so long ago.
fs::path put_lock_of_another_machine(const fs::path& folder, milliseconds age) {
  const LockOwner owner{
      {"node7", "another boot", 4711, 99}, "2026-03-01T09:14:07Z", "crisp record -o out", true};
  fs::path file = folder / ".crisp-lock.another";
  test::put_bytes(file, to_json_text(owner));
  fs::last_write_time(file, fs::file_time_type::clock::now() - age);
  return file;
}

TEST(FolderLock, RefusesASecondOneAndNamesProcessHostAndSinceWhen) {
  const test::TemporaryFolder folder;
  const FolderLock lock(folder.path());
  const auto owner = parse_lock_owner(test::bytes_of(only_entry_of(folder.path())));
  ASSERT_TRUE(owner);
  EXPECT_EQ(owner->process.number, getpid());
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string text = refusal_in(folder.path());
  EXPECT_THAT(text, HasSubstr("the folder " + folder.path().string() + " is in use"));
  EXPECT_THAT(text, HasSubstr("process " + std::to_string(getpid()) + " on " + host.data() +
                              " has been writing into it since " + owner->since));
  EXPECT_THAT(text, HasSubstr("files_test"));  // the command
}

TEST(FolderLock, RefusesAnotherProcess) {
  const test::TemporaryFolder folder;
  std::array<int, 2> gate{};
  ASSERT_EQ(pipe(gate.data()), 0);
  // Before the lock has a thread: what that allocates while a process is forked stays locked in the child.
  const pid_t other = start_process([&] {
    char open = 0;
    return read(gate[0], &open, 1) == 1 && !refusal_in(folder.path()).empty() ? 7 : 0;
  });
  const FolderLock lock(folder.path());
  EXPECT_EQ(write(gate[1], "x", 1), 1);
  EXPECT_EQ(status_of_ended(other), 7);
  close(gate[0]);
  close(gate[1]);
}

TEST(FolderLock, LeavesNothingBehindAndLetsTheNextOneIn) {
  const test::TemporaryFolder folder;
  { const FolderLock lock(folder.path()); }
  EXPECT_EQ(entries_of(folder.path()), 0);
  EXPECT_EQ(refusal_in(folder.path()), "");
}

TEST(FolderLock, IsTakenOverFromADeadProcess) {
  const test::TemporaryFolder folder;
  leave_lock_behind(folder.path());
  const FolderLock lock(folder.path());
  const auto owner = parse_lock_owner(test::bytes_of(only_entry_of(folder.path())));
  ASSERT_TRUE(owner);
  EXPECT_EQ(owner->process.number, getpid());
}

TEST(FolderLock, IsTakenOverFromADeadProcessWhoseParentHasNotRequestedItsStatus) {
  const test::TemporaryFolder folder;
  const pid_t child = start_process([&] {
    new FolderLock(folder.path());
    return 0;
  });
  siginfo_t ended = {};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(refusal_in(folder.path()), "");
  status_of_ended(child);
}

TEST(FolderLock, IsTakenOverFromADeadProcessWhoseNumberAnotherHasNow) {
  const test::TemporaryFolder folder;
  leave_lock_behind(folder.path());
  const fs::path file = only_entry_of(folder.path());
  auto owner = parse_lock_owner(test::bytes_of(file));
  ASSERT_TRUE(owner);
  owner->process.number = getpid();  // which lives, but started at another time
  owner->process.start += 100000;    // clock ticks: far from that of this process
  test::put_bytes(file, to_json_text(*owner));
  EXPECT_EQ(refusal_in(folder.path()), "");
}

TEST(FolderLock, OfAnotherMachineIsKeptWithinItsLease) {
  const test::TemporaryFolder folder;
  const fs::path file = put_lock_of_another_machine(folder.path(), hours(1));
  EXPECT_THAT(
      refusal_in(folder.path(), {.lease = hours(2)}),
      HasSubstr(
          "process 4711 on node7 has been writing into it since 2026-03-01T09:14:07Z (crisp record -o out)"));
  EXPECT_EQ(only_entry_of(folder.path()), file);
}

TEST(FolderLock, OfAnotherMachineIsTakenOverAfterItsLease) {
  const test::TemporaryFolder folder;
  const fs::path file = put_lock_of_another_machine(folder.path(), hours(3));
  const FolderLock lock(folder.path(), {.lease = hours(2)});
  EXPECT_NE(only_entry_of(folder.path()), file);
}

TEST(FolderLock, ThatIsJustBeingMadeIsKeptWithinItsLease) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / ".crisp-lock.empty", "");
  fs::last_write_time(folder / ".crisp-lock.empty", fs::file_time_type::clock::now() - hours(3));
  EXPECT_THAT(refusal_in(folder.path(), {.plate_timeout = milliseconds(1), .lease = hours(4)}),
              HasSubstr("another process is about to lock it"));
  EXPECT_EQ(refusal_in(folder.path(), {.lease = hours(2)}), "");
}

TEST(FolderLock, IsRenewedByItsOwner) {
  const test::TemporaryFolder folder;
  const FolderLock lock(folder.path(), {.heartbeat = milliseconds(1)});
  const fs::path file = only_entry_of(folder.path());
  const auto past = fs::file_time_type::clock::now() - hours(1);
  fs::last_write_time(file, past);
  while (fs::last_write_time(file) <= past) std::this_thread::sleep_for(milliseconds(1));
}

TEST(FolderLock, KnowsThatItWasTakenOver) {
  const test::TemporaryFolder folder;
  const FolderLock lock(folder.path(), {.heartbeat = milliseconds(1)});
  EXPECT_FALSE(lock.is_lost());
  fs::remove(only_entry_of(folder.path()));
  while (!lock.is_lost()) std::this_thread::sleep_for(milliseconds(1));
}

TEST(FolderLock, NamesAFolderThatCannotBeWritten) {
  EXPECT_THAT(refusal_in("/proc"), HasSubstr("cannot write into the folder /proc"));
}

/// Processes that all try to take one folder's lock at once. The winners keep it until all have tried.
class Race {
 public:
  explicit Race(fs::path folder) : folder_(std::move(folder)) {
    for (auto* ends : {&start_, &result_, &end_}) {
      if (pipe(ends->data()) != 0) throw std::runtime_error("no pipe");
    }
  }
  ~Race() {
    for (auto* ends : {&start_, &result_, &end_}) {
      for (const int end : *ends) {
        if (end >= 0) close(end);
      }
    }
  }
  Race(const Race&) = delete;
  Race& operator=(const Race&) = delete;

  int winners(int claimants) {
    std::vector<pid_t> children;
    for (int i = 0; i < claimants; ++i) children.push_back(start_process([this] { return claim(); }));
    close_end(start_[1]);  // begin
    int won = 0;
    for (int i = 0; i < claimants; ++i) won += next_result() == 'w' ? 1 : 0;
    close_end(end_[1]);
    for (const pid_t child : children) EXPECT_EQ(status_of_ended(child), 0);
    return won;
  }

 private:
  static void close_end(int& end) {
    close(end);
    end = -1;
  }

  static void wait_until_closed(const std::array<int, 2>& ends) {
    close(ends[1]);
    char none = 0;
    while (read(ends[0], &none, 1) > 0) {
    }
  }

  char next_result() {
    char result = '?';
    EXPECT_EQ(read(result_[0], &result, 1), 1);
    return result;
  }

  int claim() {
    wait_until_closed(start_);
    std::optional<FolderLock> lock;
    try {
      lock.emplace(folder_);
    } catch (const Error&) {
    }
    const char result = lock ? 'w' : 'l';
    if (write(result_[1], &result, 1) != 1) return 1;
    wait_until_closed(end_);
    return 0;
  }

  fs::path folder_;
  std::array<int, 2> start_{}, result_{}, end_{};
};

TEST(FolderLock, IsTakenByExactlyOneOfSeveralProcesses) {
  for (int round = 0; round < 20; ++round) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(Race(folder.path()).winners(6), 1);
  }
}

TEST(FolderLock, IsTakenOverFromADeadProcessByExactlyOneOfSeveral) {
  const test::TemporaryFolder folder;
  for (int round = 0; round < 20; ++round) {
    leave_lock_behind(folder.path());
    EXPECT_EQ(Race(folder.path()).winners(6), 1);
  }
}

TEST(LockOwner, ComesBackFromItsText) {
  const LockOwner owner{{"host", "boot \"x\"", 12, 345}, "2026-03-01T09:14:07Z", "crisp run 'a\nb'", false};
  EXPECT_EQ(parse_lock_owner(to_json_text(owner)), owner);
  EXPECT_EQ(parse_lock_owner(""), std::nullopt);
  EXPECT_EQ(parse_lock_owner("{\"process\": \"x\"}"), std::nullopt);
}

}  // namespace
}  // namespace crisp
