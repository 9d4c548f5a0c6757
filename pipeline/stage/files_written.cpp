// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/files_written.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "pipeline/stage/name_pattern.hpp"

namespace crisp::stage {
namespace {

namespace fs = std::filesystem;

/// One spelling for each file, whatever links lead to it.
fs::path one_name(const fs::path& file) {
  std::error_code failure;
  const fs::path name = fs::weakly_canonical(fs::absolute(file), failure);
  return failure ? fs::absolute(file).lexically_normal() : name;
}

/// The name under which a file is written: a link of that name is replaced, not followed.
fs::path name_in_folder(const fs::path& file) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  return one_name(whole.parent_path()) / whole.filename();
}

/// The names of a file that is read: its own, and that of the file that it leads to if it is a link; of a
/// folder those of the files in it that have one of the endings, too.
std::vector<NamePattern> names_read(const fs::path& path, const std::vector<std::string>& endings) {
  std::vector<NamePattern> names{NamePattern(one_name(path))};
  if (const fs::path own = name_in_folder(path); own != one_name(path)) names.emplace_back(own);
  std::error_code none;
  if (!fs::is_directory(path, none)) return names;
  for (const auto& ending : endings) names.push_back(NamePattern::within(one_name(path), "*" + ending));
  return names;
}

/// A path that a stage was given, or the run itself, and the files that this means.
struct OwnFiles {
  std::string who;
  Place place;
  std::vector<NamePattern> names;
};

/// All files written for this path, with those named after it.
std::vector<NamePattern> names_written(const Option& option, const fs::path& path) {
  std::vector<NamePattern> names;
  for (const auto& shape : option.writes) {
    if (shape == kFileItself)
      names.emplace_back(name_in_folder(path));
    else if (option.is_folder)
      names.push_back(NamePattern::within(one_name(path), shape));
    else
      names.push_back(NamePattern::given(name_in_folder(path), shape));
  }
  const std::size_t files = names.size();
  for (std::size_t i = 0; i < files; ++i) names.push_back(names[i] + kProvenance);
  return names;
}

/// Files that the stages read and write, by their options.
struct FilesOfStages {
  std::vector<OwnFiles> read;
  std::vector<OwnFiles> written;
};

FilesOfStages files_of(const Pipeline& pipeline, const FilesOfRun& run) {
  FilesOfStages files;
  for (const auto& node : pipeline.nodes) {
    if (!node.type) continue;
    for (const auto& option : node.type->options) {
      if (option.type != OptionType::path) continue;
      const OptionValue value = node.value(option);
      const auto* scalar = std::get_if<OptionScalar>(&value);
      const auto* text = scalar ? std::get_if<std::string>(scalar) : nullptr;
      if (!text || text->empty()) continue;
      if (option.writes.empty())
        files.read.push_back({node.tag, node.place_of(option.name), names_read(*text, run.read_in_folders)});
      else
        files.written.push_back(
            {node.tag, node.place_of(option.name), names_written(option, fs::absolute(*text))});
    }
  }
  return files;
}

/// Adds an error if one of the files that `writer` makes can be one of `other`.
void refuse_same(const OwnFiles& writer, const OwnFiles& other, const char* what_other_does,
                 std::vector<Error>& errors) {
  for (const auto& own : writer.names) {
    const auto theirs =
        std::ranges::find_if(other.names, [&](const NamePattern& name) { return own.overlaps(name); });
    if (theirs == other.names.end()) continue;
    const std::string how =
        own == *theirs ? "it would overwrite " : "its " + own.shown() + " could overwrite ";
    errors.emplace_back(
        fmt::format("{}: {}{}, which {} {}", writer.who, how, theirs->shown(), other.who, what_other_does),
        "let it write another file", writer.place);
    return;
  }
}

/// Adds an error if a folder has the name of one of the files that `writer` makes.
void refuse_folders(const OwnFiles& writer, std::vector<Error>& errors) {
  for (const auto& name : writer.names) {
    const auto file = name.file();
    std::error_code unknown;
    if (!file || !fs::is_directory(*file, unknown)) continue;
    errors.emplace_back(
        fmt::format("{}: where {} would be written there is a folder", writer.who, file->string()),
        "remove the folder, or name another file", writer.place);
  }
}

}  // namespace

void check_files_written(const Pipeline& pipeline, const FilesOfRun& run, std::vector<Error>& errors) {
  FilesOfStages files = files_of(pipeline, run);
  OwnFiles& read_already = files.read.emplace_back();
  read_already.who = "this run";
  for (const auto& file : run.read) {
    if (!file.empty()) std::ranges::copy(names_read(file, {}), std::back_inserter(read_already.names));
  }
  std::vector<OwnFiles> others;
  if (!run.summary.empty()) {
    OwnFiles& own = others.emplace_back();
    own.who = "this run";
    own.names.emplace_back(name_in_folder(run.summary));
    refuse_folders(own, errors);
    for (const auto& reader : files.read) refuse_same(own, reader, "reads", errors);
  }
  for (const auto& writer : files.written) {
    refuse_folders(writer, errors);
    const std::size_t before = errors.size();
    for (const auto& reader : files.read) {
      if (errors.size() == before) refuse_same(writer, reader, "reads", errors);
    }
    for (const auto& other : others) {
      if (errors.size() == before) refuse_same(writer, other, "writes", errors);
    }
    others.push_back(writer);
  }
}

}  // namespace crisp::stage
