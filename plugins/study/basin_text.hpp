// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "plugins/study/basin.hpp"

namespace crisp::study {

/// Number of starts by their ending.
struct BasinTally {
  std::size_t starts = 0;
  std::size_t same = 0;
  std::size_t with_caveats = 0;       ///< elsewhere, with caveats
  std::size_t silent = 0;             ///< elsewhere, and sure
  std::size_t same_with_caveats = 0;  ///< of `same`: with caveats all the same
  std::size_t failed = 0;             ///< recordings that cannot be calibrated even from the truth: no starts
};
BasinTally tally_of(const std::vector<BasinRecording>& recordings);

/// For people: the tally, and each start that ended elsewhere.
std::string basin_text(const std::vector<BasinRecording>& recordings);

/// Every start, a line a parameter: "recording,start,parameter,unit,value,ending,off,farthest,error,caveats";
/// SI, `off` in standard errors.
std::string basin_csv(const std::vector<BasinRecording>& recordings);

}  // namespace crisp::study
