// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/stage_caveats.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crisp::stage {
namespace {

/// Stages dominated by the stage `by` for this kind: every path of their items passes through it.
std::vector<std::size_t> dominated_by(const StageWorkers& workers, std::size_t by, const std::string& kind) {
  std::vector<bool> is_dominated(workers.size(), false);
  is_dominated[by] = true;
  std::vector<std::size_t> list;
  for (std::size_t i = by; i-- > 0;) {
    std::size_t fed = 0;
    bool elsewhere = false;
    for (const auto& edge : workers[i].edges) {
      if (edge.kind.name() != kind) continue;
      ++fed;
      elsewhere = elsewhere || !is_dominated[edge.to];
    }
    is_dominated[i] = fed > 0 && !elsewhere;
    if (is_dominated[i]) list.push_back(i);
  }
  return list;
}

/// Calls `take` with each stage whose caveats another one resolves, that other stage, and its reason.
template <class Take>
void for_each_resolved(const StageWorkers& workers, Take take) {
  for (std::size_t by = 0; by < workers.size(); ++by) {
    for (const auto& [kind, why] : workers[by].result.report.lifted) {
      for (const std::size_t i : dominated_by(workers, by, kind)) take(i, by, why);
    }
  }
}

}  // namespace

void resolve_caveats(StageWorkers& workers) {
  for_each_resolved(workers, [&](std::size_t i, std::size_t by, const std::string& why) {
    StageReport& report = workers[i].result.report;
    for (std::string& caveat : std::exchange(report.caveats, {})) {
      caveat += "; " + workers[by].result.tag;
      caveat += ": " + why;
      report.warnings.push_back(std::move(caveat));
    }
  });
}

std::vector<std::string> caveats_above(const StageWorkers& workers, std::size_t index) {
  std::vector<bool> is_resolved(workers.size(), false);
  for_each_resolved(workers, [&](std::size_t i, std::size_t, const std::string&) { is_resolved[i] = true; });
  std::vector<bool> feeds(workers.size(), false);
  feeds[index] = true;
  for (std::size_t i = index; i-- > 0;) {
    feeds[i] = std::ranges::any_of(workers[i].edges, [&](const auto& edge) { return feeds[edge.to]; });
  }
  std::vector<std::string> caveats;
  for (std::size_t i = 0; i < index; ++i) {
    if (feeds[i] && !is_resolved[i])
      std::ranges::copy(workers[i].result.report.caveats, std::back_inserter(caveats));
  }
  return caveats;
}

}  // namespace crisp::stage
