// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <set>
#include <system_error>

#include <crisp/error.hpp>

#include "pipeline/batch/glob.hpp"
#include "pipeline/batch/output_name.hpp"
#include "pipeline/files/list_files.hpp"

namespace crisp::batch {
namespace {

namespace fs = std::filesystem;

fs::path absolute_of(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();  // "captures/" is "captures"
}

bool is_inside(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

class Finder {
 public:
  explicit Finder(const BatchInputs& inputs) : inputs_(inputs), output_(absolute_of(inputs.output)) {}

  std::vector<BatchInput> find() {
    AllErrors errors;
    for (const auto& given : inputs_.given) errors.keep_of([&] { add_given(given); });
    errors.throw_any();
    // An input given twice is one recording, named as it was found first.
    std::ranges::stable_sort(found_, {}, &BatchInput::path);
    const auto same_path = [](const BatchInput& a, const BatchInput& b) { return a.path == b.path; };
    found_.erase(std::unique(found_.begin(), found_.end(), same_path), found_.end());
    std::ranges::sort(found_, {}, &BatchInput::name);
    return std::move(found_);
  }

 private:
  void add_given(const std::string& given) {
    std::error_code none;
    if (given == "-") return add_list(std::cin, fs::current_path());
    if (fs::is_directory(given, none)) return add(absolute_of(given), absolute_of(given));
    if (fs::exists(given, none) && is_list(given)) return add_list_file(given);
    if (fs::exists(given, none)) return add(absolute_of(given), absolute_of(given).parent_path());
    if (!is_pattern(given)) throw Error("there is no input " + given, "check the name after -i");
    const auto matches = match_pattern(given);
    if (matches.empty())
      throw Error("no file matches " + given,
                  "check the pattern, and quote it: the shell changes it otherwise");
    for (const auto& match : matches) {
      const fs::path path = absolute_of(match);
      if (!is_output(path)) add(path, absolute_of(fixed_part(given)));
    }
  }

  bool is_list(const fs::path& file) const {
    return file.extension() == ".txt" && !files::has_extension(file, inputs_.extensions);
  }

  bool is_output(const fs::path& path) const { return path == output_ || is_inside(path, output_); }

  void add_list_file(const fs::path& file) {
    std::ifstream list(file);
    if (!list) throw Error("cannot read the list " + file.string(), "check its rights");
    add_list(list, absolute_of(file).parent_path());
    if (list.bad()) throw Error("cannot read the list " + file.string(), "check the disk");
  }

  /// @param folder  that relative paths are relative to
  void add_list(std::istream& list, const fs::path& folder) {
    for (std::string line; std::getline(list, line);) {
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
      if (line.empty() || line.front() == '#') continue;
      const fs::path path = absolute_of(folder / line);
      std::error_code none;
      const bool exists = fs::exists(path, none);
      add(path, is_inside(path, folder) ? folder : path.parent_path(), exists ? "" : "there is no such file");
    }
  }

  void add(const fs::path& path, const fs::path& base, const std::string& unreadable = {}) {
    std::error_code none;
    const bool is_folder = fs::is_directory(path, none);
    if (is_folder) return add_folder(path, base, {});
    if (inputs_.unit == BatchUnit::folder && unreadable.empty())
      return add_recording(path.parent_path(), base, {}, true);
    add_recording(path, base, unreadable);
  }

  /// @param above  the folders that it lies in, links followed: a link to one of them leads nowhere new
  void add_folder(const fs::path& folder, const fs::path& base, std::set<fs::path> above) {
    std::error_code failure;
    if (!above.insert(fs::canonical(folder, failure)).second) return;
    bool holds_recordings = false;
    fs::directory_iterator entry(folder, failure);
    for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
      const fs::path& path = entry->path();
      std::error_code none;
      const bool is_folder = entry->is_directory(none);
      if (path.filename().native().starts_with(".") || (is_folder && path == output_)) continue;
      if (is_folder) {
        add_folder(path, base, above);
      } else if (files::has_extension(path, inputs_.extensions)) {
        holds_recordings = true;
        if (inputs_.unit == BatchUnit::file) add_recording(path, base, {});
      }
    }
    if (failure)
      add_recording(folder, base, "the folder cannot be read: " + failure.message(), true);
    else if (holds_recordings && inputs_.unit == BatchUnit::folder)
      add_recording(folder, base, {}, true);
  }

  void add_recording(const fs::path& path, const fs::path& base, const std::string& unreadable,
                     bool is_folder = false) {
    const std::string folder = path.parent_path().string();
    if (folder != folder_ || base != base_) set_folder(folder, base);
    const bool is_top = path == top_;
    if (is_outside_ && !is_top)
      throw Error(path.string() + " does not lie in " + top_.string(), "give a folder above it as --base");
    std::string name = (is_top ? "" : relative_) + path.filename().string();
    if (!is_folder) name.resize(name.size() - path.extension().native().size());
    found_.push_back({output_name(name), path.string(), is_folder, unreadable});
  }

  /// Sets the offset of the relative names in a folder: found once for all of them.
  void set_folder(const std::string& folder, const fs::path& base) {
    folder_ = folder;
    base_ = base;
    top_ = inputs_.base.empty() ? base : absolute_of(inputs_.base);
    const fs::path relative = fs::path(folder).lexically_relative(top_);
    is_outside_ = relative.empty() || *relative.begin() == "..";
    relative_ = relative == "." ? "" : relative.string() + "/";
  }

  const BatchInputs& inputs_;
  fs::path output_;
  std::vector<BatchInput> found_;
  std::string folder_;  ///< of the recording that was found last …
  fs::path base_;
  fs::path top_;
  std::string relative_;  ///< … relative to `top_`, with a slash at its end
  bool is_outside_ = false;
};

/// The recording whose output is a folder above that of this name; nullptr if there is none.
const BatchInput* recording_above(const std::vector<BatchInput>& sorted, std::string_view name) {
  for (std::size_t end = name.find('/'); end != std::string_view::npos; end = name.find('/', end + 1)) {
    const auto above = name.substr(0, end);
    const auto found = std::ranges::lower_bound(sorted, above, {}, &BatchInput::name);
    if (found != sorted.end() && found->name == above) return &*found;
  }
  return nullptr;
}

Error shared_output(const BatchInput& one, const BatchInput& other) {
  return Error(
      fmt::format("{} and {} would share the output {}", one.path, other.path, one.name),
      "give the folder above both as --base, give one of them another name, or, if they are captures of one scanner, use --each folder");
}

/// @param sorted  by name
void refuse_shared_outputs(const std::vector<BatchInput>& sorted) {
  constexpr std::size_t kMax = 10;  // that are named
  std::vector<Error> errors;
  std::string_view folder;  // of the recording before, which has no recording above it
  for (std::size_t i = 0; i < sorted.size() && errors.size() < kMax; ++i) {
    const BatchInput& recording = sorted[i];
    const std::string_view name = recording.name;
    const std::string_view own_folder = name.substr(0, name.find_last_of('/') + 1);
    const BatchInput* above = own_folder == folder ? nullptr : recording_above(sorted, name);
    if (!above) folder = own_folder;
    if (i > 0 && sorted[i - 1].name == name) above = &sorted[i - 1];
    if (above) errors.push_back(shared_output(*above, recording));
    if (is_reserved_output(name))
      errors.emplace_back(
          fmt::format("{} would have the output {}, which belongs to the batch itself", recording.path, name),
          "give it another name, or the folder above it as --base");
  }
  if (!errors.empty()) throw Errors(std::move(errors));
}

}  // namespace

std::vector<BatchInput> find_recordings(const BatchInputs& inputs) {
  auto recordings = Finder(inputs).find();
  refuse_shared_outputs(recordings);
  return recordings;
}

}  // namespace crisp::batch
