// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

// Plain pointers only: what is behind is compiled once for each kind of processor.
namespace crisp::simd {

/// Number of elements by which arrays must be readable, and accumulators writable, beyond their last element.
inline constexpr std::size_t kPadding = 16;

/// Points in tiles. In kernel units, the squared distance of two points is −log₂ of their kernel G / G(0).
struct TileArrays {
  const float* offset[3];      ///< slot → position relative to the middle of its tile's box [kernel units]
  const float* weight;         ///< slot → weight
  const double* low[3];        ///< tile → its box [m]; whole groups of 8 tiles, filled up with empty boxes
  const double* high[3];       ///< tile → its box [m]
  const std::uint32_t* begin;  ///< tile → its first slot; one more than tiles
  std::size_t size;            ///< tiles
};

struct PairKernel {
  double radius;  ///< [m] cut-off
  double scale;   ///< [kernel units / m]
  float floor;    ///< G / G(0) at the cut-off
};

/// The sums of one task: a run of tiles, in whole groups of 8. Pairs within the run are computed once for
/// both; of a pair that leaves it, only its own point's share.
struct TaskSums {
  std::size_t first_tile = 0;
  std::size_t last_tile = 0;  ///< one past
  float* gradient[3] = {};  ///< slot − first slot of the task → Σⱼ wⱼ G(xᵢ − xⱼ)/G(0) · (xᵢ − xⱼ) [kernel
                            ///< units]; null: unwanted
  double kernel = 0;  ///< Σᵢ Σⱼ wᵢ wⱼ (G/G(0) − floor) over the i of this task and all j in the radius
  std::uint64_t pairs = 0;   ///< such ordered pairs (i, j)
  std::uint64_t tested = 0;  ///< distances computed
};

/// Adds to a task what the tiles of one of its groups get from the tiles of all groups near it.
void add_group(const TileArrays& tiles, const PairKernel& kernel, std::size_t group,
               const std::uint32_t* near, std::size_t near_count, TaskSums& sums);

/// 2^−t for 0 ≤ t ≤ 100, the exponential inside, for the tests. Its relative error is below 2e-7.
void exp2_minus(const float* t, std::size_t n, float* result);

/// The instruction set that this machine's sums are computed with: "AVX3", "AVX2", "SSE4" …
const char* instruction_set();

}  // namespace crisp::simd
