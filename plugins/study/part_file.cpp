// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/part_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/data/counted.hpp"
#include "pipeline/files/json_text.hpp"

namespace crisp::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kPartFile = "part.json";

/// Nothing if the file is no part of a study of this key.
std::optional<StudyResults> results_in(const fs::path& file, const std::string& key) {
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object() || json.value("key", "") != key || !json.contains("results")) return std::nullopt;
  return json["results"].get<StudyResults>();
}

std::vector<fs::path> part_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  fs::directory_iterator entry(folder, failure);
  for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
    std::error_code none;
    if (fs::exists(entry->path() / kPartFile, none)) files.push_back(entry->path() / kPartFile);
  }
  if (failure)
    throw Error("cannot read " + folder.string() + ": " + failure.message(),
                "run the parts with --shard i/n");
  std::ranges::sort(files);
  return files;
}

void require_all(const std::map<std::uint64_t, Json>& found, const StudyExtent& extent,
                 const fs::path& folder) {
  std::size_t missing = 0;
  std::uint64_t first = 0;
  for (std::uint64_t seed = extent.first_seed; seed < extent.first_seed + extent.runs; ++seed) {
    if (!found.contains(seed) && missing++ == 0) first = seed;
  }
  if (missing == 0) return;
  throw Error(fmt::format("{} of the study are missing in {}, the first has the seed {}",
                          data::counted(missing, "run"), folder.string(), first),
              "run the missing parts with --shard i/n; a part that was run ends at once");
}

}  // namespace

void check_part(const StudyPart& part, const RunSettings& run) {
  if (!part.is_part()) return;
  static_cast<void>(batch::parse_shard(part.part));
  if (part.is_merge()) throw Error("a part of a study does not merge the parts", "give `part` or `merge`");
  if (run.output.empty()) throw Error("a part of a study has no folder for its results", "give one with -o");
}

std::optional<StudyResults> read_own_part(const Context& context, const StudyPart& part,
                                          const StudyExtent& extent) {
  auto results = results_in(context.run().output / kPartFile, part.key);
  if (!results || results->size() != share_of(batch::parse_shard(part.part), extent.runs))
    return std::nullopt;
  return results;
}

void write_own_part(Context& context, const StudyPart& part, const StudyExtent& extent,
                    const StudyResults& results) {
  const Json json = {{"key", part.key}, {"part", part.part}, {"runs", extent.runs}, {"results", results}};
  const fs::path file = context.run().output / kPartFile;
  write_file(file, files::json_text(json) + "\n");
  context.wrote(file);
  context.report({{"runs", results.size()}});
  context.print(
      fmt::format("part {}: {} of {}", part.part, results.size(), data::counted(extent.runs, "run")));
}

StudyResults merge_parts(Context& context, const StudyPart& part, const StudyExtent& extent) {
  std::map<std::uint64_t, Json> found;
  for (const auto& file : part_files(part.merge)) {
    auto results = results_in(file, part.key);
    if (!results) {
      throw Error(
          file.string() +
              " is damaged, or of a study with other options, another seed or another version of crisp",
          "merge with the options of the parts, or remove it and run its part again");
    }
    context.reads(file);
    for (auto& result : *results)
      found.insert_or_assign(result.at("seed").get<std::uint64_t>(), std::move(result));
  }
  require_all(found, extent, part.merge);
  StudyResults all;
  for (auto& [seed, result] : found) all.push_back(std::move(result));
  return all;
}

}  // namespace crisp::study
