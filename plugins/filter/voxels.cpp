// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include <crisp/error.hpp>
#include <crisp/first_in_voxel.hpp>

namespace crisp {

std::size_t Voxels::Hash::operator()(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (const auto index : cell) {  // one round of splitmix64 an index, so that neighbours lie apart
    hash += static_cast<std::uint32_t>(index) + 0x9e3779b97f4a7c15ULL;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
    hash ^= hash >> 31;
  }
  return hash;
}

Voxels::Voxels(double size) : size_(size) {
  if (std::isfinite(size) && size > 0) return;
  throw Error(fmt::format("a voxel's edge is {} m", size), "give a length above 0");
}

InVoxel Voxels::put(float x, float y, float z) {
  Cell cell{};
  std::size_t axis = 0;
  for (const float coordinate : {x, y, z}) {
    const double index = std::floor(static_cast<double>(coordinate) / size_);
    if (std::isnan(index)) return InVoxel::nowhere;
    if (std::abs(index) >= std::numeric_limits<std::int32_t>::max()) return InVoxel::too_far;
    cell[axis++] = static_cast<std::int32_t>(index);
  }
  return taken_.insert(cell).second ? InVoxel::first : InVoxel::later;
}

}  // namespace crisp
