// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/study/monte_carlo_trial.hpp"
#include "plugins/study/parallel_runs.hpp"
#include "plugins/study/study_part.hpp"

namespace crisp::study {

struct MonteCarloSettings {
  TrialSettings trial;
  std::uint64_t first_seed = 1;  ///< run k has the seed first_seed + k
  std::size_t runs = 1500;
  batch::Shard part;  ///< which of them are done
  unsigned threads = 1;
};

/// Runs all trials of the part, in the order of their seeds. What each gives depends on its seed alone, and
/// not on the number of threads. Interrupted, it returns early, with trials missing.
std::vector<MonteCarloTrial> run_trials(const MonteCarloSettings& settings, const MakeMeasure& make_measure,
                                        const StudyHooks& hooks = {});

}  // namespace crisp::study
