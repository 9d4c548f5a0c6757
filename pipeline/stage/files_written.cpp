// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/files_written.hpp"

#include <fmt/format.h>

#include <map>

namespace crisp {
namespace {

namespace fs = std::filesystem;

/// One spelling for each file, whatever links lead to it.
fs::path one_name(const fs::path& file) {
  std::error_code failure;
  const fs::path name = fs::weakly_canonical(fs::absolute(file), failure);
  return failure ? fs::absolute(file).lexically_normal() : name;
}

/// A path that a stage was given.
struct OwnFile {
  const PipelineNode* node = nullptr;
  fs::path file;
  bool written = false;
};

std::vector<OwnFile> files_of(const Pipeline& pipeline) {
  std::vector<OwnFile> files;
  for (const auto& node : pipeline.nodes) {
    for (const auto& option : node.type->options) {
      if (option.type != OptionType::path) continue;
      const OptionValue value = node.value(option);
      const auto* scalar = std::get_if<OptionScalar>(&value);
      const auto* text = scalar ? std::get_if<std::string>(scalar) : nullptr;
      if (text && !text->empty()) files.push_back({&node, one_name(*text), option.writes});
    }
  }
  return files;
}

}  // namespace

void check_files_written(const Pipeline& pipeline, const std::vector<fs::path>& read_already,
                         std::vector<Error>& errors) {
  const std::vector<OwnFile> files = files_of(pipeline);
  std::map<fs::path, std::string> readers;
  for (const auto& file : read_already) {
    if (!file.empty()) readers.emplace(one_name(file), "this run");
  }
  for (const auto& own : files) {
    if (!own.written) readers.emplace(own.file, own.node->tag);
  }
  std::map<fs::path, const PipelineNode*> writers;
  for (const auto& [node, file, written] : files) {
    if (!written) continue;
    if (const auto reader = readers.find(file); reader != readers.end()) {
      errors.emplace_back(
          fmt::format("{}: it would overwrite {}, which {} reads", node->tag, file.string(), reader->second),
          "let it write another file", node->place);
    } else if (const auto [first, is_new] = writers.emplace(file, node); !is_new) {
      errors.emplace_back(fmt::format("{}: it would overwrite {}, which {} writes", node->tag, file.string(),
                                      first->second->tag),
                          "let it write another file", node->place);
    }
  }
}

}  // namespace crisp
