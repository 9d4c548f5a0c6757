// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/cell_runs.hpp"

namespace crisp::report {

std::vector<CellRun> cell_runs(const quality::SpatialOrder& order, unsigned levels) {
  constexpr unsigned kBits = 3;  // of a key, one an axis
  std::vector<CellRun> runs;
  for (std::size_t i = 0; i < order.cell.size(); ++i) {
    if (runs.empty() || order.cell[i] >> (kBits * levels) != order.cell[i - 1] >> (kBits * levels))
      runs.push_back({.begin = i, .end = i});
    runs.back().end = i + 1;
  }
  return runs;
}

}  // namespace crisp::report
