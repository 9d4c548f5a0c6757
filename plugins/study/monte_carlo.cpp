// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/monte_carlo.hpp"

namespace crisp::study {

std::vector<MonteCarloTrial> run_trials(const MonteCarloSettings& settings, const MakeMeasure& make_measure,
                                        const StudyHooks& hooks) {
  return run_in_parallel<MonteCarloTrial>(
      share_of(settings.part, settings.runs), settings.threads, hooks, [&](std::size_t k) {
        return run_trial(settings.trial, settings.first_seed + run_of(settings.part, k), make_measure);
      });
}

}  // namespace crisp::study
