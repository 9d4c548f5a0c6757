// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "plugins/study/basin.hpp"

namespace crisp {

/// How many starts ended how.
struct BasinTally {
  std::size_t starts = 0;
  std::size_t same = 0;
  std::size_t doubted = 0;       ///< elsewhere, and said so
  std::size_t silent = 0;        ///< elsewhere, and sure
  std::size_t same_doubted = 0;  ///< of `same`: said that they were not sure all the same
  std::size_t failed = 0;        ///< recordings that cannot be calibrated even from the truth: no starts
};
BasinTally tally_of(const std::vector<BasinRecording>& recordings);

/// For people: the tally, and each start that ended elsewhere.
std::string basin_text(const std::vector<BasinRecording>& recordings);

/// Every start, a line a parameter: "recording,start,parameter,unit,value,ending,off,farthest,error,doubts";
/// SI, `off` in standard errors.
std::string basin_csv(const std::vector<BasinRecording>& recordings);

}  // namespace crisp
