// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cluster/slurm.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <pwd.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace crisp::test {
namespace {

namespace fs = std::filesystem;

/// TCP ports that nobody listens at.
std::vector<int> free_ports(std::size_t count) {
  std::vector<int> ports;
  std::vector<int> sockets;
  while (ports.size() < count) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    socklen_t size = sizeof address;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    sockets.push_back(socket(AF_INET, SOCK_STREAM, 0));
    if (bind(sockets.back(), any, size) != 0 || getsockname(sockets.back(), any, &size) != 0)
      throw std::runtime_error("no free port");
    ports.push_back(ntohs(address.sin_port));
  }
  for (const int one : sockets) close(one);
  return ports;
}

std::string short_host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  const std::string whole = name.data();
  return whole.substr(0, whole.find('.'));
}

bool is_installed(const std::string& program) {
  return std::system(("PATH=$PATH:/usr/sbin:/sbin command -v " + program + " > /dev/null").c_str()) == 0;
}

std::vector<pid_t> all_processes() {
  std::vector<pid_t> processes;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator("/proc", failure)) {
    const std::string name = entry.path().filename();
    pid_t number = 0;
    const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (wrong == std::errc() && end == name.data() + name.size()) processes.push_back(number);
  }
  return processes;
}

void kill_and_wait(pid_t process) {
  if (process <= 0) return;
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
}

}  // namespace

std::string variable_of(pid_t process, const std::string& variable) {
  std::ifstream file("/proc/" + std::to_string(process) + "/environ", std::ios::binary);
  for (std::string entry; std::getline(file, entry, '\0');) {
    if (entry.starts_with(variable + "=")) return entry.substr(variable.size() + 1);
  }
  return {};
}

std::string Slurm::missing() {
  std::string text;
  for (const char* program : {"slurmctld", "slurmd", "sbatch", "munged", "mungekey", "setpriv"}) {
    if (!is_installed(program)) text += text.empty() ? program : std::string(", ") + program;
  }
  return text;
}

Slurm::Slurm(fs::path folder) : folder_(std::move(folder)) {
  fs::create_directories(folder_ / "state");
  fs::permissions(folder_, fs::perms(0755));  // munge refuses a socket that others cannot reach
  const std::string path = std::string(std::getenv("PATH")) + ":/usr/sbin:/sbin";
  setenv("PATH", path.c_str(), 1);
  setenv("SLURM_CONF", (folder_ / "slurm.conf").c_str(), 1);
  write_configuration();
  const std::string munge = (folder_ / "munge.").string();
  int status = 0;
  waitpid(start({"mungekey", "--create", "--keyfile=" + munge + "key"}), &status, 0);
  munge_ =
      start({"setpriv", "--pdeathsig", "KILL", "munged", "--foreground", "--force",
             "--socket=" + munge + "socket", "--key-file=" + munge + "key", "--log-file=" + munge + "log",
             "--pid-file=" + munge + "pid", "--seed-file=" + munge + "seed"});
  while (!fs::exists(munge + "socket") && waitpid(munge_, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  controller_ = start({"setpriv", "--pdeathsig", "KILL", "slurmctld", "-D"});
  for (std::size_t i = 0; i < kNodes.size(); ++i)
    nodes_[i] = start({"setpriv", "--pdeathsig", "KILL", "slurmd", "-D", "-N", kNodes[i]});
  wait_until_idle();
}

Slurm::~Slurm() {
  for (const char* node : kNodes) kill_node(node);
  kill_and_wait(controller_);
  kill_and_wait(munge_);
}

/// See slurm.conf(5). A node counts as dead after SlurmdTimeout; a task of it begins again after cred_expire.
void Slurm::write_configuration() {
  const std::string folder = folder_.string();
  const std::string host = short_host_name();
  const passwd* user = getpwuid(getuid());
  const std::string owner = user ? user->pw_name : "root";
  const auto ports = free_ports(kNodes.size() + 1);
  std::ofstream file(folder_ / "slurm.conf");
  file
      << "ClusterName=test\n"
      << fmt::format("SlurmctldHost={}(127.0.0.1)\nSlurmctldPort={}\n", host, ports.back())
      << fmt::format("AuthType=auth/munge\nAuthInfo=socket={}/munge.socket,cred_expire=5\n", folder)
      << "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSwitchType=switch/none\nMpiDefault=none\n"
      << fmt::format("ReturnToService=2\nSlurmUser={0}\nSlurmdUser={0}\n", owner)
      << fmt::format("SlurmctldPidFile={0}/ctld.pid\nSlurmdPidFile={0}/slurmd.%n.pid\n", folder)
      << fmt::format("SlurmdSpoolDir={0}/spool.%n\nStateSaveLocation={0}/state\n", folder)
      << fmt::format("SlurmctldLogFile={0}/ctld.log\nSlurmdLogFile={0}/slurmd.%n.log\n", folder)
      << "SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nAccountingStorageType=accounting_storage/none\n"
      << "SlurmdTimeout=5\n";
  for (std::size_t i = 0; i < kNodes.size(); ++i)
    file << fmt::format("NodeName={} NodeHostname={} NodeAddr=127.0.0.1 Port={} CPUs=1 State=UNKNOWN\n",
                        kNodes[i], host, ports[i]);
  file << "PartitionName=debug Nodes=n[1-3] Default=YES MaxTime=INFINITE State=UP\n";
}

pid_t Slurm::start(std::vector<std::string> words) const {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND;
  posix_spawn_file_actions_addopen(&actions, 1, (folder_ / "daemons.log").c_str(), kFlags, 0600);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t child = -1;
  const int failure = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::runtime_error("cannot start " + words.front());
  return child;
}

void Slurm::wait_until_idle() const {
  const std::string idle =
      "test $(sinfo --noheader --Node --states=idle --format=%N 2> /dev/null | wc -l) = 3";
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::system(idle.c_str()) != 0) {
    std::ostringstream log;
    if (std::chrono::steady_clock::now() > give_up) {
      log << std::ifstream(folder_ / "daemons.log").rdbuf();
      throw std::runtime_error("Slurm's nodes are not idle after a minute:\n" + log.str());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

void Slurm::kill_node(const std::string& node) {
  const auto number = static_cast<std::size_t>(std::ranges::find(kNodes, node) - kNodes.begin());
  kill_and_wait(nodes_.at(number));
  nodes_[number] = -1;
  kill_sessions(processes_with("SLURMD_NODENAME", node));
}

std::string Slurm::wait_for_job(const std::string& job) const {
  const std::string command = "scontrol show job " + job;
  while (true) {
    std::string text;
    std::array<char, 4096> block{};
    FILE* pipe = popen(command.c_str(), "r");
    while (pipe && fgets(block.data(), block.size(), pipe)) text += block.data();
    if (!pipe || pclose(pipe) != 0) return "there is no such job";
    const auto field = [&](const std::string& name) {
      const std::size_t begin = text.find(name + "=") + name.size() + 1;
      return text.substr(begin, text.find_first_of(" \n", begin) - begin);
    };
    const std::string state = field("JobState");
    if (state != "PENDING" && state != "RUNNING" && state != "COMPLETING") return field("ExitCode");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
}

std::vector<pid_t> Slurm::processes_with(const std::string& variable, const std::string& value) const {
  std::vector<pid_t> found;
  for (const pid_t process : all_processes()) {
    if (variable_of(process, variable) == value &&
        variable_of(process, "SLURM_CONF") == (folder_ / "slurm.conf").string())
      found.push_back(process);
  }
  return found;
}

void Slurm::kill_sessions(const std::vector<pid_t>& processes) const {
  std::set<pid_t> sessions;
  for (const pid_t process : processes) sessions.insert(getsid(process));
  sessions.erase(-1);         // of one that has ended meanwhile
  sessions.erase(getsid(0));  // no task's
  std::vector<pid_t> members;
  for (const pid_t process : all_processes()) {
    if (sessions.contains(getsid(process))) members.push_back(process);
  }
  // First what would report the others' end to the controller: it began before them.
  std::ranges::sort(members);
  for (const pid_t process : members) kill(process, SIGKILL);
}

}  // namespace crisp::test
