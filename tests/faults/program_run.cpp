// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/program_run.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>

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
  alarm(kLongestRun);
  execv(CRISP_PROGRAM, words.data());
  _exit(126);
}

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

ProgramEnd run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                       const Fault& fault) {
  const TemporaryFolder own;
  const auto log = own / "calls";
  const auto messages = own / "messages";
  const pid_t child = fork();
  if (child == 0) {
    setenv("LD_PRELOAD", CRISP_FAULT_PRELOAD, 1);
    setenv("CRISP_FAULT_FOLDER", folder.c_str(), 1);
    setenv("CRISP_FAULT_LOG", log.c_str(), 1);
    setenv("CRISP_FAULT_CALL", std::to_string(fault.call).c_str(), 1);
    setenv("CRISP_FAULT_KIND", fault.kind.c_str(), 1);
    become_program(arguments, messages);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ProgramEnd end;
  if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.messages = bytes_of(messages);
  end.calls = calls_in(bytes_of(log));
  return end;
}

}  // namespace crisp::test
