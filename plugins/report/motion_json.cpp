// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/motion_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace crisp::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kCells = 36;  // of a turn

double rounded(double value, double step) { return std::round(value / step) * step; }

/// Which of the cells of a turn an angle [rad] is in.
std::size_t cell_of_turn(double angle) {
  const double turns = angle / kTurn;
  return std::min(static_cast<std::size_t>(static_cast<double>(kCells) * (turns - std::floor(turns))),
                  kCells - 1);
}

}  // namespace

Json motion_json(const PlateTrajectory& plate, std::size_t most) {
  constexpr double kMillisecond = 1e-3, kFine = 1e-4;
  Json times = Json::array(), angles = Json::array(), rates = Json::array();
  const std::size_t step = std::max<std::size_t>(1, (plate.size() + most - 1) / most);
  double last = plate.empty() ? 0 : plate.begin();
  for (std::size_t i = 0; i < plate.size(); ++i) {
    const double time = plate.times()[i];
    const bool is_behind_gap = time - last > plate.max_gap();
    last = time;
    if (is_behind_gap) {
      for (Json* list : {&times, &angles, &rates}) list->push_back(nullptr);
    }
    if (i % step != 0 && !is_behind_gap) continue;
    times.push_back(rounded(time - plate.begin(), kMillisecond));
    angles.push_back(rounded(plate.angles()[i] / kTurn, kFine));
    rates.push_back(rounded(plate.rates()[i] / kTurn, kFine));
  }
  return {{"time", times}, {"turns", angles}, {"rate", rates}};
}

Json coverage_json(const estimate::Sample& sample, const std::vector<std::string>& lasers) {
  std::vector<std::array<std::array<std::uint32_t, kCells>, kCells>> counts(lasers.size());
  for (std::size_t i = 0; i < sample.beams.size(); ++i) {
    const auto plate = sample.plate->at(sample.beams.time[i]);
    if (!plate || sample.beams.laser[i] >= lasers.size()) continue;
    const double mirror = static_cast<double>(sample.beams.mirror_angle[i]) + std::numbers::pi;
    ++counts[sample.beams.laser[i]][cell_of_turn(mirror)][cell_of_turn(plate->angle)];
  }
  Json all = Json::array();
  for (std::size_t laser = 0; laser < lasers.size(); ++laser)
    all.push_back({{"laser", lasers[laser]}, {"counts", counts[laser]}});
  return all;
}

}  // namespace crisp::report
