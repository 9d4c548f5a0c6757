// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace crisp::data {

/// A pool of reusable objects. An object that nobody holds any more returns to the pool, from whatever
/// thread, and is filled anew, so that a stream allocates its memory once and not for every scan. The pool
/// keeps as many objects as were ever held at a time; held objects may outlive the pool.
template <class T>
class Pool {
 public:
  /// A thing that holds anything, and that nobody else has.
  std::shared_ptr<T> get() {
    std::unique_ptr<T> thing = free_->take();
    if (!thing) thing = std::make_unique<T>();
    return {thing.release(), [free = free_](T* used) { free->give_back(std::unique_ptr<T>(used)); }};
  }

 private:
  class Free {
   public:
    std::unique_ptr<T> take() {
      const std::lock_guard lock(mutex_);
      if (things_.empty()) {
        if (++made_ > things_.capacity()) things_.reserve(2 * made_);  // so that coming back never fails
        return nullptr;
      }
      auto thing = std::move(things_.back());
      things_.pop_back();
      return thing;
    }
    void give_back(std::unique_ptr<T> thing) {
      const std::lock_guard lock(mutex_);
      things_.push_back(std::move(thing));
    }

   private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> things_;
    std::size_t made_ = 0;
  };

  std::shared_ptr<Free> free_ = std::make_shared<Free>();
};

}  // namespace crisp::data
