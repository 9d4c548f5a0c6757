// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/running_jobs.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "pipeline/data/exception_to_error.hpp"

namespace crisp::batch {
namespace {

constexpr std::size_t kMaxPrinted = 16 * 1024;  // [bytes] that are kept of what a job prints

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// The end of the text, from the beginning of a line.
std::string last_lines(const std::string& text) {
  constexpr std::size_t kMax = 4096;
  if (text.size() <= kMax) return text;
  const std::string end = text.substr(text.size() - kMax);
  const std::size_t line = end.find('\n');
  return line == std::string::npos ? end : end.substr(line + 1);
}

}  // namespace

RunningJobs::RunningJobs(const JobLauncher::Run& run, std::vector<int> close_in_jobs)
    : run_(run), close_in_jobs_(std::move(close_in_jobs)) {}

RunningJobs::~RunningJobs() {
  for (const auto& [process, job] : running_) kill(-process, SIGKILL);
  while (waitpid(-1, nullptr, 0) > 0 || errno == EINTR) continue;
}

void RunningJobs::become(const Job& job, int error) const {
  const pid_t launcher = getppid();
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != launcher) _exit(1);  // it died before that was set
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int null = open("/dev/null", O_RDWR);
  dup2(null, STDIN_FILENO);
  dup2(null, STDOUT_FILENO);
  dup2(error, STDERR_FILENO);
  for (const int descriptor : {null, error}) {
    if (descriptor > STDERR_FILENO) close(descriptor);
  }
  for (const int descriptor : close_in_jobs_) close(descriptor);
  for (const auto& [process, other] : running_) close(other.error);
  int status = 1;
  try {
    status = run_(job);
  } catch (const std::exception& failure) {
    const Error error = data::error_of(failure);
    std::cerr << "error: " << error.what() << "\n";
  } catch (...) {
    std::cerr << "error: a plugin threw something that is no std::exception\n";
  }
  std::cout.flush();
  std::cerr.flush();
  std::fflush(nullptr);
  _exit(status);  // what lives until the end of the program is the launcher's
}

std::optional<JobEnd> RunningJobs::start(const Job& job) {
  const auto refused = [&] {
    return JobEnd{.id = job.id,
                  .exit_status = 1,
                  .error = std::string("error: cannot start a process: ") + std::strerror(errno) +
                           "; run fewer --jobs"};
  };
  std::array<int, 2> error{};
  if (pipe2(error.data(), O_CLOEXEC) != 0) return refused();
  const pid_t process = fork();
  if (process == 0) {
    close(error[0]);
    become(job, error[1]);
  }
  close(error[1]);
  if (process < 0) {
    auto end = refused();
    close(error[0]);
    return end;
  }
  setpgid(process, process);  // as the job does itself: whoever is first
  fcntl(error[0], F_SETFL, O_NONBLOCK);
  running_[process] = {.id = job.id, .error = error[0], .began = std::chrono::steady_clock::now()};
  return std::nullopt;
}

void RunningJobs::signal(std::uint64_t id, int signal) {
  for (const auto& [process, job] : running_) {
    if (job.id == id) kill(-process, signal);
  }
}

void RunningJobs::add_to(std::vector<pollfd>& polled) const {
  for (const auto& [process, job] : running_) {
    if (job.error >= 0) polled.push_back({.fd = job.error, .events = POLLIN, .revents = 0});
  }
}

void RunningJobs::read_error(Running& job) {
  std::array<char, 4096> block{};
  while (job.error >= 0) {
    const ssize_t count = read(job.error, block.data(), block.size());
    if (count > 0) {
      job.printed.append(block.data(), static_cast<std::size_t>(count));
      if (job.printed.size() > kMaxPrinted) job.printed.erase(0, job.printed.size() - kMaxPrinted / 2);
    } else if (count == 0) {
      close(job.error);
      job.error = -1;
    } else if (errno != EINTR) {
      return;
    }
  }
}

void RunningJobs::read_errors() {
  for (auto& [process, job] : running_) read_error(job);
}

std::vector<JobEnd> RunningJobs::reap() {
  std::vector<JobEnd> ended;
  int status = 0;
  rusage usage{};
  while (true) {
    const pid_t process = wait4(-1, &status, WNOHANG, &usage);
    if (process <= 0) return ended;
    const auto found = running_.find(process);
    if (found == running_.end()) continue;
    Running& job = found->second;
    read_error(job);
    if (job.error >= 0) close(job.error);
    kill(-process, SIGKILL);  // what it left running
    ended.push_back(
        {.id = job.id,
         .exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
         .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
         .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - job.began).count(),
         .cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime),
         .memory = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024,
         .error = last_lines(job.printed)});
    running_.erase(found);
  }
}

}  // namespace crisp::batch
