// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "pipeline/batch/shard.hpp"

namespace crisp::study {

/// Which of a study's runs are done: all of them, those of one part of several (every n-th run), or none, as
/// the results of all parts are merged.
struct StudyPart {
  std::string part = {};             ///< "3/64"; empty: all
  std::filesystem::path merge = {};  ///< the folder of all parts, which are merged; empty: they are not
  std::string key = {};              ///< only parts of the same key are of one study

  bool is_part() const { return !part.empty(); }
  bool is_merge() const { return !merge.empty(); }
};

/// Number of a part's runs.
inline std::size_t share_of(const batch::Shard& part, std::size_t runs) {
  return runs < part.number ? 0 : (runs - part.number) / part.count + 1;
}

/// The number among all runs, from 0, of a part's k-th one.
inline std::size_t run_of(const batch::Shard& part, std::size_t k) {
  return part.number - 1 + k * part.count;
}

/// @param way  to a StudyPart
template <class S, class Way>
void describe_part(S& d, Way way) {
  d.option(
      "part", way, &StudyPart::part,
      "`3/64`: compute only every 64th run, from the third on; its results go to part.json in the output folder");
  d.option("merge", way, &StudyPart::merge, "folder of the parts' output folders: only merge their results");
  d.option(
      "part_key", way, &StudyPart::key,
      "key that parts to merge must share; `crisp monte-carlo` and `crisp basin` derive it from their options");
}

}  // namespace crisp::study
