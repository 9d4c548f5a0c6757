// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include <crisp/error.hpp>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace crisp::quality {

namespace detail {

/// The thread sanitizer does not see how TBB hands work over and back, as that library is built without it.
/// This annotates it: the release before happened before the acquire now. (One place for all, since even a
/// worker's captures are handed over.)
struct Handover {
  char place = 0;
#ifdef __SANITIZE_THREAD__
  void give() { __tsan_release(&place); }
  void take() { __tsan_acquire(&place); }
#else
  void give() {}
  void take() {}
#endif
};
inline Handover to_workers;
inline Handover from_workers;

}  // namespace detail

inline std::size_t blocks_of(std::size_t n, std::size_t size) { return (n + size - 1) / size; }

/// Calls work(block, begin, end) for consecutive blocks of 0 … n − 1, in parallel. What a block is depends on
/// nothing but n and size, so that sums made a block at a time do not depend on the threads.
/// @throws  what one of them threw; the others may then not have been called
template <class Work>
void for_blocks(std::size_t n, std::size_t size, const Work& work) {
  if (n > 0 && n <= size)
    return work(std::size_t{0}, std::size_t{0}, n);  // to hand it over costs a microsecond
  const auto one = [&](std::size_t block) {
    detail::to_workers.take();
    work(block, block * size, std::min(n, (block + 1) * size));
    detail::from_workers.give();
  };
  detail::to_workers.give();
  tbb::task_group_context group;  // is cancelled with that of the block that this is called in
  tbb::parallel_for(std::size_t{0}, blocks_of(n, size), one, group);
  detail::from_workers.take();
  // Then another exception was thrown, which is reported there, and blocks are missing here.
  if (group.is_group_execution_cancelled()) throw Interrupted();
}

/// The sum of what add(sum, begin, end) adds up of each block, each beginning with `zero`, in their order.
template <class Sum, class Add>
Sum sum_over_blocks(std::size_t n, std::size_t size, const Sum& zero, const Add& add) {
  std::vector<Sum> blocks(blocks_of(n, size), zero);
  for_blocks(n, size,
             [&](std::size_t block, std::size_t begin, std::size_t end) { add(blocks[block], begin, end); });
  Sum total = zero;
  for (const Sum& block : blocks) total += block;
  return total;
}

/// Calls work(i) for each of some arrays, in parallel where what they hold is worth it.
template <class Work>
void for_each_array(std::size_t arrays, std::size_t elements, const Work& work) {
  constexpr std::size_t kMany = 65536;
  for_blocks(arrays, elements < kMany ? arrays : 1, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

/// Calls work(i) for i = 0 … n − 1, in parallel.
template <class Work>
void for_each_index(std::size_t n, const Work& work) {
  for_blocks(n, 1, [&](std::size_t, std::size_t i, std::size_t) { work(i); });
}

}  // namespace crisp::quality
