// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include <crisp/context.hpp>

#include "plugins/study/study_part.hpp"

namespace crisp::study {

/// All runs of a study: run k has the seed first_seed + k.
struct StudyExtent {
  std::uint64_t first_seed = 1;
  std::size_t runs = 0;
};

/// Results of runs, each an object with its `seed`, that has every digit.
using StudyResults = std::vector<nlohmann::json>;

/// @throws Error if the part is no part, or has no folder to write to
void check_part(const StudyPart& part, const RunSettings& run);

/// The results of a part, if an earlier run of it wrote them, with the same key.
std::optional<StudyResults> read_own_part(const Context& context, const StudyPart& part,
                                          const StudyExtent& extent);

/// Writes the results of a part to part.json in the output folder, and reports how many they are.
void write_own_part(Context& context, const StudyPart& part, const StudyExtent& extent,
                    const StudyResults& results);

/// The results of all parts, by seed.
/// @throws Error if there are parts of another key, or runs are missing
StudyResults merge_parts(Context& context, const StudyPart& part, const StudyExtent& extent);

/// The results of the runs that this run is to do, or to merge.
/// @param compute    does them
/// @param from_json  reads one that was done before
template <class Run>
std::vector<Run> run_or_read(Context& context, const StudyPart& part, const StudyExtent& extent,
                             const std::function<std::vector<Run>()>& compute,
                             Run (*from_json)(const nlohmann::json&)) {
  std::optional<StudyResults> known;
  if (part.is_merge()) known = merge_parts(context, part, extent);
  if (part.is_part()) known = read_own_part(context, part, extent);
  if (!known) return compute();
  std::vector<Run> runs;
  runs.reserve(known->size());
  for (const auto& json : *known) runs.push_back(from_json(json));
  return runs;
}

/// @return whether this run does a part only, which is written thereby, and nothing else is to be
template <class Run>
bool write_if_part(Context& context, const StudyPart& part, const StudyExtent& extent,
                   const std::vector<Run>& runs, nlohmann::json (*to_json)(const Run&)) {
  if (!part.is_part()) return false;
  StudyResults results;
  for (const auto& run : runs) results.push_back(to_json(run));
  write_own_part(context, part, extent, results);
  return true;
}

}  // namespace crisp::study
