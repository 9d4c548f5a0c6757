// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <optional>
#include <utility>

#include <crisp/rig_file.hpp>

#include "pipeline/app/commands.hpp"
#include "pipeline/files/byte_stream.hpp"
#include "pipeline/files/json_text.hpp"
#include "pipeline/files/list_files.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

/// A file and what it holds, or what is wrong with it.
struct Entry {
  std::string name;
  const Inspector* inspector = nullptr;  ///< of its kind
  Inspection inspection;
  std::string error;  ///< message for people; empty: none
};

/// The first bytes of a file; empty if the file cannot be read, since reading it reports the error.
std::string head_of(const fs::path& file) {
  constexpr std::size_t kEnough = 4096;
  std::string head(kEnough, '\0');
  std::size_t size = 0;
  try {
    files::ByteStream stream(file);
    while (size < kEnough) {
      const std::size_t got = stream.read(head.data() + size, kEnough - size);
      if (got == 0) break;
      size += got;
    }
  } catch (const Error&) {
  }
  head.resize(size);
  return head;
}

/// The kind of a YAML file that only other commands read, with advice; nothing for other files.
std::optional<Error> of_other_commands(const fs::path& file) {
  const std::string head = "\n" + head_of(file);
  if (head.find("\ncrisp:") == std::string::npos) return std::nullopt;
  if (head.find("\npipeline:") != std::string::npos)
    return Error(file.string() + " is a pipeline", "crisp validate checks it, crisp run runs it");
  if (head.find("\nlasers:") != std::string::npos)
    return Error(file.string() + " is a rig", "crisp validate checks it, --rig takes it");
  return std::nullopt;
}

Error none_known(const fs::path& path, const Inspectors& inspectors) {
  if (fs::is_regular_file(path)) {
    if (fs::file_size(path) == 0) return Error(path.string() + " is empty", "copy or record it again");
    if (const auto other = of_other_commands(path)) return *other;
  }
  std::string kinds;
  for (const auto& inspector : inspectors) kinds += (kinds.empty() ? "" : ", ") + inspector.kind;
  const char* what =
      fs::is_directory(path) ? " holds no file of a known kind" : " is of no known kind of file";
  return Error(path.string() + what, "known are " + kinds);
}

/// Whether the file would be of a known kind, by its name.
bool is_named_like_one(const Inspectors& inspectors, const fs::path& file) {
  return std::ranges::any_of(inspectors, [&](const Inspector& inspector) {
    return files::has_extension(file, inspector.extensions);
  });
}

/// @throws Error if it cannot be read; fs::filesystem_error
Entry read_entry(const Inspectors& inspectors, const fs::path& file, const Rig& rig) {
  if (!fs::exists(file)) throw Error("there is no file " + file.string(), "check its name");
  if (!fs::is_regular_file(file)) throw Error(file.string() + " is not a file", "name a file");
  const std::string head = head_of(file);
  const auto knows = [&](const Inspector& inspector) { return inspector.recognises(head); };
  const auto inspector = std::ranges::find_if(inspectors, knows);
  if (inspector == inspectors.end()) throw none_known(file, inspectors);
  return {.name = file.string(), .inspector = &*inspector, .inspection = inspector->inspect(file, rig)};
}

Entry entry_of(const Inspectors& inspectors, const fs::path& file, const Rig& rig) {
  try {
    return read_entry(inspectors, file, rig);
  } catch (const Error& error) {
    return {.name = file.string(), .error = error_text(error)};
  } catch (const fs::filesystem_error& error) {
    return {.name = file.string(),
            .error = error_text(Error(error.what(), "check its name and its permissions"))};
  }
}

/// A folder may also hold notes and results, which are not listed.
bool is_of_interest(const Inspectors& inspectors, const fs::path& file) {
  const std::string head = head_of(file);
  return is_named_like_one(inspectors, file) ||
         std::ranges::any_of(inspectors, [&](const auto& inspector) { return inspector.recognises(head); });
}

std::vector<Entry> entries_of(const Inspectors& inspectors, const fs::path& path, const Rig& rig) {
  std::error_code none;
  if (!fs::is_directory(path, none)) return {entry_of(inspectors, path, rig)};
  std::vector<Entry> entries;
  try {
    for (const auto& file : files::list_files(path)) {
      if (is_of_interest(inspectors, file)) entries.push_back(entry_of(inspectors, file, rig));
    }
    if (entries.empty()) throw none_known(path, inspectors);
  } catch (const Error& error) {
    entries.push_back({.name = path.string(), .error = error_text(error)});
  }
  return entries;
}

/// The content of each file under its name.
nlohmann::json json_of(const std::vector<Entry>& entries) {
  auto all = nlohmann::json::object();
  for (const auto& entry : entries) {
    all[entry.name] = entry.error.empty() ? entry.inspection.data : nlohmann::json{{"error", entry.error}};
  }
  return all;
}

/// Whether these are two files of one kind that are compared side by side.
bool are_compared(const std::vector<Entry>& entries) {
  return entries.size() == 2 && entries[0].inspector && entries[0].inspector == entries[1].inspector &&
         entries[0].inspector->compare;
}

void print_compared(const Entry& first, const Entry& second) {
  std::cout << "first:  " << first.name << ": " << first.inspector->kind << "\nsecond: " << second.name
            << ": " << second.inspector->kind << "\n"
            << first.inspector->compare(first.name, second.name) << "\n";
}

void print(const std::vector<Entry>& entries) {
  for (const auto& entry : entries) {
    const bool failed = !entry.error.empty();
    std::cout << entry.name << ": " << (failed ? "not read" : entry.inspector->kind) << "\n"
              << (failed ? entry.error : entry.inspection.text) << "\n";
  }
}

/// The files as URDF. @throws Error if one is of a kind that has none
ExitStatus print_urdf(const std::vector<Entry>& entries, const Rig& rig) {
  for (const auto& entry : entries) {
    if (!entry.error.empty()) {
      std::cerr << entry.error << "\n";
      return ExitStatus::failed;
    }
    if (!entry.inspector->urdf)
      throw Error(entry.name + " is " + entry.inspector->kind + ", which URDF cannot hold",
                  "give a calibration");
    std::cout << entry.inspector->urdf(entry.name, rig) << "\n";
  }
  return ExitStatus::done;
}

}  // namespace

ExitStatus info_command(const InfoRequest& request, const Registrar& registrar) {
  Rig rig = default_rig();
  try {
    if (request.rig) rig = read_rig(*request.rig);
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::failed;
  }
  std::vector<Entry> entries;
  for (const auto& path : request.paths) {
    std::ranges::move(entries_of(registrar.inspectors(), path, rig), std::back_inserter(entries));
  }
  if (request.urdf) return print_urdf(entries, rig);
  const bool one = request.paths.size() == 1 && entries[0].name == request.paths[0].string();
  if (one && !entries[0].error.empty())
    std::cerr << entries[0].error << "\n";
  else if (request.json)
    std::cout << files::json_text(one ? entries[0].inspection.data : json_of(entries), 2) << "\n";
  else if (are_compared(entries))
    print_compared(entries[0], entries[1]);
  else
    print(entries);
  const bool all_read = std::ranges::all_of(entries, &std::string::empty, &Entry::error);
  return all_read ? ExitStatus::done : ExitStatus::failed;
}

}  // namespace crisp::app
