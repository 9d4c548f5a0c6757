// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/property.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "tests/faults/file_state.hpp"

namespace crisp::test {
namespace {

/// The name that a person knows a file by: of a part that of the file that it becomes, of a lock its
/// folder's.
std::string known_name(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  if (name.starts_with(".crisp-lock") || name.starts_with('#')) return file.parent_path().filename().string();
  if (!is_hidden(name) || !name.ends_with(".part")) return name;
  const std::string stem = name.substr(1, name.size() - 6);
  return stem.substr(0, stem.rfind('.'));
}

class Judge {
 public:
  Judge(const Stage& stage, const Fault& fault) : stage_(stage), fault_(fault) {}

  Verdict judge() {
    stage_.reset();
    end_ = stage_.run(fault_);
    const Files files = list_files(stage_.output());
    check_end();
    check_inputs();
    if (is_done()) {
      for (const auto& name : differing(files))
        violate("exit " + std::to_string(end_.status) + ", but " + name + " is not what it should be");
    } else {
      check_files(files);
    }
    const bool has_left_over =
        std::ranges::any_of(files, [](const auto& file) { return is_hidden(file.first); });
    // A batch that cannot go on kills its jobs; the next one removes what they leave.
    const bool ends_jobs = stage_.scenario().command == Command::batch && fault_.kind == "full";
    if (has_left_over && !fault_.kills() && call() != "unlink" && !ends_jobs) violate("a part is left over");
    if (has_left_over || fault_.kills()) check_next_run();
    return std::move(verdict_);
  }

 private:
  bool is_done() const { return end_.signal == 0 && end_.status == stage_.status(); }
  void violate(const std::string& what) { verdict_.violations.push_back(what); }
  /// The call of the fault; none where the program was killed at some moment.
  std::string call() const { return fault_.call == 0 || end_.calls.empty() ? "" : end_.calls.front().name; }
  bool is_live() const { return stage_.scenario().command == Command::record; }

  void check_end() {
    using End = Verdict::End;
    if (end_.signal != 0) {
      verdict_.end = End::killed;
      if (!fault_.kills() || end_.signal != SIGKILL)
        violate("ended by signal " + std::to_string(end_.signal));
      return;
    }
    constexpr std::array kEnds = {End::survived, End::failed, End::refused, End::untrusted};
    const bool is_documented = end_.status >= 0 && end_.status < static_cast<int>(kEnds.size());
    if (!is_documented) return violate(fmt::format("exit status {}", end_.status));
    verdict_.end = is_done() ? End::survived : kEnds.at(static_cast<std::size_t>(end_.status));
    if (!is_done()) check_message();
  }

  /// What a message has to name.
  std::string culprit() const {
    if (fault_.kills()) return "illed";  // a process of the batch
    // On a full disk a later call fails, too, and is what is named.
    if (fault_.kind == "full") return "No space left on device";
    if (fault_.kind == "starved") return "memory";
    return end_.calls.front().needs_memory() ? "memory" : known_name(end_.calls.front().file);
  }

  void check_message() {
    if (call().empty()) return;
    if (end_.messages.find(culprit()) == std::string::npos)
      violate(fmt::format("exit {}, and no message has {}: {}", end_.status, culprit(), end_.messages));
  }

  void check_inputs() {
    if (list_files(stage_.input()) != stage_.inputs()) violate("an input has changed");
  }

  std::vector<std::string> differing(const Files& files) const {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : stage_.undisturbed()) {
      const bool is_right = is_live() ? files.contains(name) && is_whole(name, files.at(name), false)
                                      : same_file(name, files, stage_.undisturbed());
      if (!is_right) names.push_back(name);
    }
    for (const auto& [name, bytes] : files) {
      if (!is_hidden(name) && !stage_.undisturbed().contains(name)) names.push_back(name);
    }
    return names;
  }

  /// Each file is that of the earlier run or of the undisturbed one.
  void check_files(const Files& files) {
    for (const auto& [name, bytes] : files) {
      if (is_hidden(name)) continue;
      if (is_record(name)) {
        if (!is_whole(name, bytes, false)) violate(name + " is half-written");
      } else if (name == stage_.scenario().grows || is_account(name)) {
        if (!is_whole(name, bytes, fault_.kills())) violate(name + " is damaged");
      } else if (!same_file(name, files, stage_.earlier()) && !same_file(name, files, stage_.undisturbed())) {
        violate(name + " is half-written, or of neither run");
      }
    }
    for (const auto& [name, bytes] : stage_.earlier()) check_kept(name, bytes, files);
    check_records(files);
  }

  void check_kept(const std::string& name, const std::string& bytes, const Files& files) {
    const bool is_numbered =
        name.find("_0") != std::string::npos;  // removed where they are beyond this run's
    if (is_record(name) || is_account(name) || is_numbered || !stage_.undisturbed().contains(name)) return;
    if (!files.contains(name)) violate(name + " of the earlier run is gone");
    if (name == stage_.scenario().grows && files.contains(name) && !files.at(name).starts_with(bytes))
      violate(name + " was shortened");
  }

  /// No record of the earlier run remains next to a file of this one.
  void check_records(const Files& files) {
    for (const auto& [name, bytes] : files) {
      const bool is_result = !is_record(name) && !is_hidden(name) && !is_account(name);
      if (!is_result || same_file(name, files, stage_.earlier())) continue;
      const std::filesystem::path path(name);
      for (const auto& record : {name + ".provenance.json", (path.parent_path() / "summary.json").string()}) {
        const auto of = stage_.earlier().find(record);
        const auto now = files.find(record);
        if (of != stage_.earlier().end() && now != files.end() && of->second == now->second)
          violate(fmt::format("{} of the earlier run next to {} of this one", record, name));
      }
    }
  }

  void check_next_run() {
    const ProgramEnd next = stage_.run_next();
    if (next.status != stage_.status()) violate("the next run fails: " + next.messages);
    const Files files = list_files(stage_.output());
    for (const auto& [name, bytes] : files) {
      // A batch does not go back into the folder of a recording that is done.
      const bool may_stay = call() == "unlink" && stage_.scenario().command == Command::batch;
      if (is_hidden(name) && !may_stay) violate("after the next run " + name + " is left over");
    }
    // What grows has been written by both runs.
    if (!stage_.scenario().grows.empty()) return;
    for (const auto& name : differing(files))
      violate("after the next run " + name + " is not what it should be");
  }

  const Stage& stage_;
  const Fault& fault_;
  ProgramEnd end_;
  Verdict verdict_;
};

}  // namespace

Verdict judge_fault(const Stage& stage, const Fault& fault) { return Judge(stage, fault).judge(); }

}  // namespace crisp::test
