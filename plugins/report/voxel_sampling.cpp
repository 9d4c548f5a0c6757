// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/voxel_sampling.hpp"

#include <algorithm>

#include "plugins/report/cell_runs.hpp"

namespace crisp::report {
namespace {

std::size_t kept_under(const std::vector<CellRun>& cells, std::size_t cap) {
  std::size_t kept = 0;
  for (const CellRun& cell : cells) kept += std::min(cap, cell.size());
  return kept;
}

/// The largest cap under which no more than `count` points are kept.
std::size_t largest_cap(const std::vector<CellRun>& cells, std::size_t count) {
  std::size_t low = 0, high = count;  // low is allowed; above high none is
  while (low < high) {
    const std::size_t cap = low + (high - low + 1) / 2;
    if (kept_under(cells, cap) <= count)
      low = cap;
    else
      high = cap - 1;
  }
  return low;
}

}  // namespace

std::vector<std::uint32_t> voxel_sample(const quality::SpatialOrder& order, std::size_t count) {
  const std::vector<CellRun> cells = cell_runs(order, 0);
  const std::size_t cap = largest_cap(cells, count);
  // The remainder below the cap: one more in the first cells that have one.
  std::size_t spare = count - kept_under(cells, cap);
  std::vector<std::uint32_t> chosen;
  chosen.reserve(std::min(count, order.index.size()));
  for (const CellRun& cell : cells) {
    std::size_t keep = std::min(cap, cell.size());
    if (keep < cell.size() && spare > 0) {
      ++keep;
      --spare;
    }
    for (std::size_t k = 0; k < keep; ++k) {
      chosen.push_back(order.index[cell.begin + k * cell.size() / keep]);
    }
  }
  return chosen;
}

}  // namespace crisp::report
