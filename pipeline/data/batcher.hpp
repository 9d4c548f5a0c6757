// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace crisp::data {

/// When what was pushed to a Batcher is worked on.
struct BatchSettings {
  std::size_t enough = 1;  ///< things that are worked on at once
  std::size_t most = 2;    ///< things that may wait, at least `enough`; who pushes more waits himself
  /// [s] after which work is done on what there is, even if that is nothing; none: not before there is enough
  std::optional<double> pause = {};
};

/// Gathers things, and works on them in a thread of its own: who pushes them does not wait for a disk.
/// What the work throws ends it; whoever pushes or drains from then on is thrown the same.
template <class T>
class Batcher {
 public:
  using Batch = std::vector<T>;
  using Work = std::function<void(Batch)>;

  Batcher(const BatchSettings& settings, Work work)
      : settings_(settings),
        work_(std::move(work)),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}
  Batcher(const Batcher&) = delete;
  Batcher& operator=(const Batcher&) = delete;
  /// Lets the work that is being done come to its end; what waits is never worked on.
  ~Batcher() = default;

  void push(T thing) {
    {
      std::unique_lock lock(mutex_);
      done_.wait(lock, [&] { return failure_ || waiting_.size() < settings_.most; });
      if (failure_) std::rethrow_exception(failure_);
      waiting_.push_back(std::move(thing));
      if (waiting_.size() < settings_.enough) return;
    }
    pushed_.notify_one();
  }

  /// Waits until all that was pushed is worked on.
  void drain() {
    std::unique_lock lock(mutex_);
    draining_ = true;
    pushed_.notify_one();
    done_.wait(lock, [&] { return failure_ || (waiting_.empty() && !working_); });
    draining_ = false;
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (await_work(lock, stop)) {
      Batch batch = std::exchange(waiting_, {});
      working_ = true;
      lock.unlock();
      std::exception_ptr failure;
      try {
        work_(std::move(batch));
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      working_ = false;
      failure_ = failure;
      done_.notify_all();
      if (failure) return;
    }
  }

  /// @return false once the thread is to end
  bool await_work(std::unique_lock<std::mutex>& lock, const std::stop_token& stop) {
    const auto is_enough = [&] {
      return waiting_.size() >= settings_.enough || (draining_ && !waiting_.empty());
    };
    if (settings_.pause) {
      pushed_.wait_for(lock, stop, std::chrono::duration<double>(*settings_.pause), is_enough);
    } else {
      pushed_.wait(lock, stop, is_enough);
    }
    return !stop.stop_requested();
  }

  BatchSettings settings_;
  Work work_;
  std::mutex mutex_;  ///< of what follows
  std::condition_variable_any pushed_;
  std::condition_variable done_;
  Batch waiting_;
  bool working_ = false;
  bool draining_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;
};

}  // namespace crisp::data
