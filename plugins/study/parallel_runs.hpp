// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/task_arena.h>

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace crisp::study {

/// Hooks to watch and stop the work from outside.
struct StudyHooks {
  std::function<void(std::size_t done)> progress = {};  ///< called in the calling thread
  std::function<bool()> interrupted = {};               ///< called in any thread
};

/// Runs that several threads take from one counter.
template <class Result>
class ParallelRuns {
 public:
  using Run = std::function<Result(std::size_t)>;

  ParallelRuns(std::size_t runs, const Run& run, const StudyHooks& hooks)
      : run_(run), hooks_(hooks), results_(runs) {}

  /// @param report  whether to report progress
  void work(bool report) {
    // A run is small: what its kernels could do on several cores is not worth the handing over.
    tbb::task_arena alone(1);
    alone.execute([&] {
      while (const auto at = next()) {
        try {
          results_[*at] = run_(*at);
        } catch (...) {
          fail(std::current_exception());
        }
        ++done_;
        if (report && hooks_.progress) hooks_.progress(done_);
      }
    });
  }

  /// The results of completed runs, in their order.
  std::vector<Result> take() {
    if (failure_) std::rethrow_exception(failure_);
    std::vector<Result> done;
    for (auto& result : results_) {
      if (result) done.push_back(std::move(*result));
    }
    return done;
  }

 private:
  std::optional<std::size_t> next() {
    if (hooks_.interrupted && hooks_.interrupted()) stopped_ = true;
    const std::size_t run = next_++;
    return stopped_ || run >= results_.size() ? std::nullopt : std::optional(run);
  }

  void fail(std::exception_ptr failure) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    stopped_ = true;
  }

  const Run& run_;
  const StudyHooks& hooks_;
  std::vector<std::optional<Result>> results_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

/// run(0) to run(runs − 1), in this order. Interrupted, it returns early, with some missing.
/// @throws what the first run to fail threw
template <class Result>
std::vector<Result> run_in_parallel(std::size_t runs, unsigned threads, const StudyHooks& hooks,
                                    const std::function<Result(std::size_t)>& run) {
  ParallelRuns<Result> all(runs, run, hooks);
  {
    std::vector<std::jthread> helpers;
    for (unsigned k = 1; k < threads; ++k) helpers.emplace_back([&] { all.work(false); });
    all.work(true);
  }
  return all.take();
}

}  // namespace crisp::study
