// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace crisp {

inline std::size_t blocks_of(std::size_t n, std::size_t size) { return (n + size - 1) / size; }

/// Calls work(block, begin, end) for consecutive blocks of 0 … n − 1, in parallel. What a block is depends on
/// nothing but n and size, so that sums made a block at a time do not depend on the threads.
template <class Work>
void for_blocks(std::size_t n, std::size_t size, const Work& work) {
  tbb::parallel_for(std::size_t{0}, blocks_of(n, size),
                    [&](std::size_t block) { work(block, block * size, std::min(n, (block + 1) * size)); });
}

}  // namespace crisp
