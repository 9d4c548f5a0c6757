// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/file_state.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/temporary_folder.hpp"

namespace crisp::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string file_name(const std::string& name) { return fs::path(name).filename().string(); }

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

/// How many recordings ended how.
Json counts_of(const std::string& batch) {
  const Json json = Json::parse(batch, nullptr, false);
  return json.is_object() ? json.value("counts", Json()) : Json();
}

/// Whether a pcap file holds whole records, but for the last one if it may be cut off.
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

bool are_json_lines(const std::string& bytes, bool may_be_cut) {
  std::istringstream lines(bytes);
  for (std::string line; std::getline(lines, line);) {
    const bool is_cut = lines.eof();  // without a line break
    if (is_cut ? !may_be_cut : !Json::accept(line)) return false;
  }
  return true;
}

}  // namespace

Files list_files(const fs::path& folder) {
  Files files;
  std::error_code none;
  if (!fs::is_directory(folder, none)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    files[entry.path().lexically_relative(folder).string()] = bytes_of(entry.path());
  }
  return files;
}

bool is_hidden(const std::string& name) { return file_name(name).starts_with('.'); }

/// What a batch says of all its recordings, with times.
bool is_account(const std::string& name) {
  constexpr std::array kNames{"batch.json", "table.csv", "trend.svg", "report.html",
                              "report.html.provenance.json"};
  return std::ranges::find(kNames, name) != kNames.end() || name.starts_with("manifest/");
}

bool is_record(const std::string& name) {
  if (is_account(name)) return false;
  return name.ends_with(".provenance.json") || file_name(name) == "summary.json";
}

bool is_whole(const std::string& name, const std::string& bytes, bool may_be_cut) {
  if (name.ends_with(".json")) return Json::accept(bytes);
  if (name.ends_with(".jsonl")) return are_json_lines(bytes, may_be_cut);
  if (name.ends_with(".pcap")) return is_capture(bytes, may_be_cut);
  return bytes.ends_with('\n');
}

bool same_file(const std::string& name, const Files& files, const Files& expected) {
  const auto found = files.find(name);
  const auto requested = expected.find(name);
  if (found == files.end() || requested == expected.end())
    return found == files.end() && requested == expected.end();
  if (is_record(name)) return same_record(found->second, requested->second);
  if (name == "batch.json") return counts_of(found->second) == counts_of(requested->second);
  if (is_account(name)) return is_whole(name, found->second, false);
  return found->second == requested->second;
}

}  // namespace crisp::test
