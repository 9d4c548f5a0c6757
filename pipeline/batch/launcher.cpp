// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/launcher.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <crisp/error.hpp>

#include "pipeline/batch/job_message.hpp"
#include "pipeline/batch/running_jobs.hpp"

namespace crisp::batch {
namespace {

/// The next message, of whole length; nothing if the other end is closed or there is none just now.
std::optional<std::string> receive(int socket, int flags) {
  std::string message(kLongestJobMessage, '\0');
  ssize_t count = 0;
  do {
    count = recv(socket, message.data(), message.size(), flags);
  } while (count < 0 && errno == EINTR);
  if (count <= 0) return std::nullopt;
  message.resize(static_cast<std::size_t>(count));
  return message;
}

void send_end(int socket, const JobEnd& end) {
  const std::string message = to_message(end);
  ::send(socket, message.data(), message.size(), MSG_NOSIGNAL);
}

/// Executes a message's command; false if the batch process is gone.
bool obey(int socket, RunningJobs& jobs) {
  const auto message = receive(socket, 0);
  if (!message) return false;
  const auto fields = split_fields(*message);
  if (fields.at(0) == "signal") {
    jobs.signal(std::stoull(fields.at(1)), std::stoi(fields.at(2)));
  } else if (const auto refused = jobs.start(job_of(fields))) {
    send_end(socket, *refused);
  }
  return true;
}

/// Main loop of the launcher's process, until the batch closes its end of the socket.
[[noreturn]] void serve(int socket, const JobLauncher::Run& run) {
  setpgid(0, 0);  // Ctrl-C at the terminal is for the batch to hear
  sigset_t child_ended;
  sigemptyset(&child_ended);
  sigaddset(&child_ended, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child_ended, nullptr);
  const int ended = signalfd(-1, &child_ended, SFD_CLOEXEC | SFD_NONBLOCK);
  {
    RunningJobs jobs(run, {socket, ended});
    while (true) {
      std::vector<pollfd> polled = {{.fd = socket, .events = POLLIN, .revents = 0},
                                    {.fd = ended, .events = POLLIN, .revents = 0}};
      jobs.add_to(polled);
      if (poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR) break;
      signalfd_siginfo signal{};
      while (read(ended, &signal, sizeof signal) > 0) continue;
      jobs.read_errors();
      for (const auto& end : jobs.reap()) send_end(socket, end);
      if (polled[0].revents != 0 && !obey(socket, jobs)) break;
    }
  }
  _exit(0);
}

[[noreturn]] void fail(const char* what) {
  throw Error(std::string(what) + ": " + std::strerror(errno), "end other programs, or raise `ulimit -u`");
}

}  // namespace

JobLauncher::JobLauncher(const Run& run) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail("cannot make a socket to start jobs through");
  const pid_t batch = getpid();
  process_ = fork();
  if (process_ == 0) {
    close(ends[0]);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != batch) _exit(1);  // it died before that was set
    serve(ends[1], run);
  }
  close(ends[1]);
  if (process_ < 0) {
    close(ends[0]);
    fail("cannot start the process that starts the jobs");
  }
  socket_ = ends[0];
}

JobLauncher::~JobLauncher() {
  close(socket_);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
}

void JobLauncher::send(const std::string& message) const {
  if (message.size() > kLongestJobMessage) {
    throw Error(
        fmt::format("the paths of a job have {} bytes, more than {}", message.size(), kLongestJobMessage),
        "use shorter paths");
  }
  if (::send(socket_, message.data(), message.size(), MSG_NOSIGNAL) >= 0) return;
  throw Error(std::string("the process that starts the jobs is gone: ") + std::strerror(errno),
              "run the batch again: it continues where it stopped");
}

void JobLauncher::start(const Job& job) const { send(to_message(job)); }

void JobLauncher::signal(std::uint64_t id, int signal) const {
  send(join_fields({"signal", std::to_string(id), std::to_string(signal)}));
}

std::optional<JobEnd> JobLauncher::wait(std::chrono::milliseconds limit) const {
  pollfd polled{.fd = socket_, .events = POLLIN, .revents = 0};
  if (poll(&polled, 1, static_cast<int>(limit.count())) <= 0) return std::nullopt;
  if (const auto message = receive(socket_, MSG_DONTWAIT)) return job_end_of(split_fields(*message));
  throw Error("the process that starts the jobs was killed",
              "run the batch again: it continues where it stopped");
}

}  // namespace crisp::batch
