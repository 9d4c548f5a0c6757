// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/property.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

namespace crisp::test {
namespace {

using Json = nlohmann::json;

bool is_hidden(const std::string& name) { return name.starts_with('.'); }
bool is_record(const std::string& name) {
  return name.ends_with(".provenance.json") || name == "summary.json";
}

/// Without what differs from run to run: when it began and how long it took.
Json without_times(Json record) {
  for (const char* key : {"started", "seconds"}) record.erase(key);
  if (record.contains("stages")) {
    for (auto& stage : record["stages"]) stage.erase("seconds");
  }
  return record;
}

bool same_record(const std::string& a, const std::string& b) {
  return without_times(Json::parse(a, nullptr, false)) == without_times(Json::parse(b, nullptr, false));
}

bool same_file(const std::string& name, const Files& files, const Files& expected) {
  const auto found = files.find(name);
  const auto wanted = expected.find(name);
  if (found == files.end() || wanted == expected.end())
    return found == files.end() && wanted == expected.end();
  return is_record(name) ? same_record(found->second, wanted->second) : found->second == wanted->second;
}

/// Whether a pcap file holds whole records, but for the last one if the program was killed.
bool is_capture(const std::string& bytes, bool may_be_cut) {
  constexpr std::size_t kFileHeader = 24;
  constexpr std::size_t kRecordHeader = 16;
  constexpr std::size_t kLengthAt = 8;
  std::size_t at = kFileHeader;
  while (at + kRecordHeader <= bytes.size()) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + at + kLengthAt, sizeof length);
    at += kRecordHeader + length;
  }
  return at == bytes.size() || bytes.empty() || (may_be_cut && bytes.size() > kFileHeader);
}

/// The name that a person knows a file by: of a part that of the file that it becomes, of a lock its
/// folder's.
std::string known_name(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
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
    const Files files = files_in(stage_.output());
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
    if (has_left_over && end_.signal == 0 && call() != "unlink") violate("a part is left over");
    if (has_left_over || end_.signal != 0) check_next_run();
    return std::move(verdict_);
  }

 private:
  bool is_done() const { return end_.signal == 0 && end_.status == stage_.status(); }
  void violate(const std::string& what) { verdict_.violations.push_back(what); }
  std::string call() const { return end_.calls.empty() ? "" : end_.calls.front().name; }

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

  void check_message() {
    if (end_.calls.empty()) return;
    // On a full disk a later call fails, too, and is what is named.
    const std::string name =
        fault_.kind == "full" ? "No space left on device" : known_name(end_.calls.front().file);
    if (end_.messages.find(name) == std::string::npos)
      violate(fmt::format("exit {}, and no message has {}: {}", end_.status, name, end_.messages));
  }

  void check_inputs() {
    if (files_in(stage_.input()) != stage_.inputs()) violate("an input has changed");
  }

  std::vector<std::string> differing(const Files& files) const {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : stage_.undisturbed()) {
      if (!same_file(name, files, stage_.undisturbed())) names.push_back(name);
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
        if (!Json::accept(bytes)) violate(name + " is half-written");
      } else if (name == stage_.scenario().grows) {
        if (!is_capture(bytes, fault_.kills())) violate(name + " is damaged");
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
    if (is_record(name) || is_numbered || !stage_.undisturbed().contains(name)) return;
    if (!files.contains(name)) violate(name + " of the earlier run is gone");
    if (name == stage_.scenario().grows && files.contains(name) && !files.at(name).starts_with(bytes))
      violate(name + " was shortened");
  }

  /// No record of the earlier run stays beside a file of this one.
  void check_records(const Files& files) {
    for (const auto& [name, bytes] : files) {
      const bool is_new = !is_record(name) && !is_hidden(name) && !same_file(name, files, stage_.earlier());
      if (!is_new) continue;
      for (const auto& record : {name + ".provenance.json", std::string("summary.json")}) {
        const auto of = stage_.earlier().find(record);
        const auto now = files.find(record);
        if (of != stage_.earlier().end() && now != files.end() && of->second == now->second)
          violate(record + " of the earlier run beside " + name + " of this one");
      }
    }
  }

  void check_next_run() {
    const ProgramEnd next = stage_.run();
    if (next.status != stage_.status()) violate("the next run fails: " + next.messages);
    const Files files = files_in(stage_.output());
    for (const auto& [name, bytes] : files) {
      if (is_hidden(name)) violate("after the next run " + name + " is left over");
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
