// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/program_run.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/support/temporary_folder.hpp"

namespace crisp::test {
namespace {

constexpr unsigned kLongestRun = 60;  // [s]; a run takes some 0.1 s

[[noreturn]] void become_program(const std::vector<std::string>& arguments,
                                 const std::filesystem::path& messages) {
  const int errors = open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  dup2(errors, STDERR_FILENO);
  dup2(open("/dev/null", O_RDWR), STDOUT_FILENO);
  std::vector<char*> words{const_cast<char*>(CRISP_PROGRAM)};
  for (const auto& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(CRISP_PROGRAM, words.data());
  _exit(126);
}

/// A pipe whose other end the program and all processes that it begins hold open.
class Descendants {
 public:
  Descendants() {
    if (pipe(ends_.data()) != 0) throw std::runtime_error("no pipe");
    fcntl(ends_[0], F_SETFD, FD_CLOEXEC);
  }
  ~Descendants() { close(ends_[0]); }
  Descendants(const Descendants&) = delete;
  Descendants& operator=(const Descendants&) = delete;

  /// To be called when the program has been started.
  void close_own_end() { close(std::exchange(ends_[1], -1)); }
  /// Returns when the last process has ended.
  void wait() const {
    char none = 0;
    while (read(ends_[0], &none, 1) < 0 && errno == EINTR) continue;
  }

 private:
  std::array<int, 2> ends_{};
};

std::vector<FileCall> calls_in(const std::string& log) {
  std::vector<FileCall> calls;
  std::istringstream lines(log);
  FileCall call;
  std::string file;
  while (lines >> call.number >> call.name && std::getline(lines >> std::ws, file)) {
    call.file = file;
    calls.push_back(call);
  }
  return calls;
}

}  // namespace

pid_t start_program(const std::vector<std::string>& arguments, const std::filesystem::path& messages) {
  const pid_t child = fork();
  if (child == 0) become_program(arguments, messages);
  return child;
}

ProgramEnd run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                       const Fault& fault) {
  using Clock = std::chrono::steady_clock;
  const TemporaryFolder own;
  const auto log = own / "calls";
  const auto messages = own / "messages";
  Descendants descendants;
  const auto began = Clock::now();
  const pid_t child = fork();
  if (child == 0) {
    setenv("LD_PRELOAD", CRISP_FAULT_PRELOAD, 1);
    setenv("CRISP_FAULT_FOLDER", folder.c_str(), 1);
    setenv("CRISP_FAULT_LOG", log.c_str(), 1);
    setenv("CRISP_FAULT_CALL", std::to_string(fault.call).c_str(), 1);
    setenv("CRISP_FAULT_KIND", fault.kind.c_str(), 1);
    alarm(kLongestRun);
    become_program(arguments, messages);
  }
  descendants.close_own_end();
  if (fault.killed_after.count() > 0) {
    std::this_thread::sleep_for(fault.killed_after);
    kill(child, SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ProgramEnd end;
  end.lasted = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - began);
  descendants.wait();
  if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.messages = bytes_of(messages);
  end.calls = calls_in(bytes_of(log));
  return end;
}

}  // namespace crisp::test
