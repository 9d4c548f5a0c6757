// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/monte_carlo.hpp"

#include <tbb/task_arena.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace crisp {
namespace {

/// Trials that several threads take from one counter.
class Trials {
 public:
  Trials(const MonteCarloSettings& settings, const MakeMeasure& make_measure, const MonteCarloHooks& hooks)
      : settings_(settings), make_measure_(make_measure), hooks_(hooks), trials_(settings.runs) {}

  /// @param tell  whether to report progress
  void work(bool tell) {
    // A run is small: what its kernels could do on several cores is not worth the handing over.
    tbb::task_arena alone(1);
    alone.execute([&] {
      while (const auto run = next()) {
        try {
          trials_[*run] = run_trial(settings_.trial, settings_.first_seed + *run, make_measure_);
        } catch (...) {
          fail(std::current_exception());
        }
        ++done_;
        if (tell && hooks_.progress) hooks_.progress(done_);
      }
    });
  }

  std::vector<Trial> take() {
    if (failure_) std::rethrow_exception(failure_);
    if (stopped_) std::erase_if(trials_, [](const Trial& trial) { return trial.parameters.empty(); });
    return std::move(trials_);
  }

 private:
  std::optional<std::size_t> next() {
    if (hooks_.interrupted && hooks_.interrupted()) stopped_ = true;
    const std::size_t run = next_++;
    return stopped_ || run >= trials_.size() ? std::nullopt : std::optional(run);
  }

  void fail(std::exception_ptr failure) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    stopped_ = true;
  }

  const MonteCarloSettings& settings_;
  const MakeMeasure& make_measure_;
  const MonteCarloHooks& hooks_;
  std::vector<Trial> trials_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<Trial> run_trials(const MonteCarloSettings& settings, const MakeMeasure& make_measure,
                              const MonteCarloHooks& hooks) {
  Trials trials(settings, make_measure, hooks);
  {
    std::vector<std::jthread> helpers;
    for (unsigned k = 1; k < settings.threads; ++k) helpers.emplace_back([&] { trials.work(false); });
    trials.work(true);
  }
  return trials.take();
}

}  // namespace crisp
