// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/echoes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace crisp::data {
namespace {

struct BeamEcho {
  float range = 0;
  float remission = 0;
};

bool came_back(float range) { return range > 0 && std::isfinite(range); }

/// The echoes of beam k that came back, in their order.
void gather(const std::vector<Echo>& echoes, std::size_t k, std::vector<BeamEcho>& out) {
  out.clear();
  for (const Echo& echo : echoes) {
    if (k >= echo.ranges.size() || !came_back(echo.ranges[k])) continue;
    out.push_back({echo.ranges[k], k < echo.remissions.size() ? echo.remissions[k] : 0});
  }
}

std::span<const BeamEcho> chosen(std::span<const BeamEcho> echoes, EchoChoice choice) {
  if (echoes.empty() || choice == EchoChoice::all) return echoes;
  if (choice == EchoChoice::first) return echoes.first(1);
  if (choice == EchoChoice::last) return echoes.last(1);
  const auto strongest = std::ranges::max_element(echoes, {}, &BeamEcho::remission);
  return echoes.subspan(static_cast<std::size_t>(strongest - echoes.begin()), 1);
}

bool is_empty(const Echo& echo) { return std::ranges::none_of(echo.ranges, came_back); }

}  // namespace

std::shared_ptr<const Scan> with_used_echoes(std::shared_ptr<const Scan> scan, EchoChoice choice,
                                             EchoCounts& counts) {
  const std::vector<Echo>& sent = scan->echoes;
  if (sent.size() < 2) return scan;
  const std::size_t beams = sent.front().ranges.size();
  const bool has_remissions =
      std::ranges::any_of(sent, [&](const Echo& echo) { return echo.remissions.size() >= beams; });
  Echo empty{.ranges = std::vector<float>(beams),
             .remissions = std::vector<float>(has_remissions ? beams : 0)};
  std::vector<Echo> used(choice == EchoChoice::all ? sent.size() : 1, empty);
  std::vector<BeamEcho> of_beam;
  for (std::size_t k = 0; k < beams; ++k) {
    gather(sent, k, of_beam);
    const auto taken = chosen(of_beam, choice);
    counts.unused += of_beam.size() - taken.size();
    if (!taken.empty() && !came_back(sent.front().ranges[k])) ++counts.later;
    for (std::size_t e = 0; e < taken.size(); ++e) {
      used[e].ranges[k] = taken[e].range;
      if (has_remissions) used[e].remissions[k] = taken[e].remission;
    }
  }
  while (used.size() > 1 && is_empty(used.back())) used.pop_back();
  auto result = std::make_shared<Scan>(*scan);
  result->echoes = std::move(used);
  return result;
}

}  // namespace crisp::data
