// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/captured_output.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <crisp/error.hpp>

namespace crisp::app {
namespace {

constexpr int kSignalled = 128;  // as shells count

/// @param to  where the program's standard output goes
/// @return 0, or the number of the error
int spawn(std::vector<std::string>& words, int to, pid_t& child) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to, STDOUT_FILENO);
  const int failure =
      posix_spawnp(&child, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failure;
}

std::string read_all(int from) {
  std::string text;
  std::array<char, 4096> block{};
  while (true) {
    const ssize_t count = read(from, block.data(), block.size());
    if (count > 0)
      text.append(block.data(), static_cast<std::size_t>(count));
    else if (count == 0 || errno != EINTR)
      return text;
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status);
}

}  // namespace

CapturedOutput capture_output(std::vector<std::string> words) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error("cannot run " + words.front() + ": " + std::strerror(errno),
                "end other programs, or raise `ulimit -n`");
  pid_t child = -1;
  const int failure = spawn(words, ends[1], child);
  close(ends[1]);
  CapturedOutput output;
  if (failure == 0) output = {.status = 0, .text = read_all(ends[0])};
  close(ends[0]);
  if (failure != 0) {
    throw Error("cannot run " + words.front() + ": " + std::strerror(failure),
                "check that it is installed and in PATH");
  }
  output.status = wait_for(child);
  return output;
}

}  // namespace crisp::app
