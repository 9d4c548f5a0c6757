// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include <crisp/error.hpp>
#include <crisp/measurement_tables.hpp>

namespace crisp {
namespace {

const std::string kPlateNote = "plate";  // digest of the trajectory's table

std::int64_t epoch_of(const PcdTable& table) {
  return table.header().note<std::int64_t>("epoch_ns").value_or(0);
}

std::vector<double> plate_angles(const Measurements& beams, const PlateTrajectory& plate) {
  std::vector<double> angles;
  angles.reserve(beams.size());
  for (const double t : beams.time) {
    const auto state = plate.at(t);
    angles.push_back(state ? state->angle : std::numeric_limits<double>::quiet_NaN());
  }
  return angles;
}

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

PcdTable to_pcd_table(const Measurements& beams, const PlateTrajectory& plate) {
  const auto angles = plate_angles(beams, plate);
  PcdTable table(beams.size());
  table.set_note("epoch_ns", std::to_string(beams.epoch_ns));
  table.set_note(kPlateNote, to_pcd_table(plate).digest());
  table.add<float>("range", [&](std::size_t i) { return beams.range[i]; });
  table.add<float>("mirror_angle", [&](std::size_t i) { return beams.mirror_angle[i]; });
  table.add<double>("time", [&](std::size_t i) { return beams.time[i]; });
  table.add<double>("plate_angle", [&](std::size_t i) { return angles[i]; });
  table.add<std::uint16_t>("laser", [&](std::size_t i) { return beams.laser[i]; });
  table.add<std::uint16_t>("beam", [&](std::size_t i) { return beams.beam[i]; });
  table.add<float>("remission", [&](std::size_t i) { return beams.remission[i]; });
  return table;
}

PcdTable to_pcd_table(const PlateTrajectory& plate) {
  PcdTable table(plate.size());
  table.set_note("epoch_ns", std::to_string(plate.epoch_ns()));
  table.set_note("max_gap", fmt::format("{}", plate.max_gap()));
  table.add<double>("time", [&](std::size_t i) { return plate.times()[i]; });
  table.add<double>("angle", [&](std::size_t i) { return plate.angles()[i]; });
  if (!plate.new_zeros().empty()) {
    table.add<std::uint16_t>("zero", [&](std::size_t i) {
      return std::ranges::count_if(plate.new_zeros(), [&](double at) { return at <= plate.times()[i]; });
    });
  }
  return table;
}

bool belong_together(const PcdTable& measurements, const PcdTable& trajectory) {
  const auto& notes = measurements.header().notes;
  const auto digest = notes.find(kPlateNote);
  return epoch_of(measurements) == epoch_of(trajectory) &&
         (digest == notes.end() || digest->second == trajectory.digest());
}

std::filesystem::path plate_path(const std::filesystem::path& measurements) {
  return measurements.parent_path() / (measurements.stem().string() + ".plate.pcd");
}

TableMeasurements measurements_of(const PcdTable& table) {
  const auto range = table.column<float>("range");
  const auto angle = table.column<float>("mirror_angle");
  const auto time = table.column<double>("time");
  const auto laser = table.column<std::uint16_t>("laser");
  const auto beam = table.column<std::uint16_t>("beam");
  const auto remission = table.column<float>("remission");
  TableMeasurements result;
  result.beams.epoch_ns = epoch_of(table);
  result.beams.reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const bool possible = range[i] > 0 && std::isfinite(range[i]) && std::isfinite(angle[i]) &&
                          std::isfinite(time[i]) && std::isfinite(remission[i]);
    if (!possible) {
      ++result.impossible;
      continue;
    }
    result.beams.range.push_back(range[i]);
    result.beams.mirror_angle.push_back(angle[i]);
    result.beams.time.push_back(time[i]);
    result.beams.laser.push_back(laser[i]);
    result.beams.remission.push_back(remission[i]);
    result.beams.beam.push_back(beam[i]);
  }
  return result;
}

PlateTrajectory trajectory_of(const PcdTable& table) {
  auto times = table.column<double>("time");
  auto angles = table.column<double>("angle");
  const double max_gap = table.header().note<double>("max_gap").value_or(0);
  if (!all_finite(times) || !all_finite(angles) || !(max_gap > 0)) {
    throw Error("some encoder readings are no numbers, or the header lacks their max_gap",
                "write the file again, or correct it: a line `# crisp max_gap 0.02` in the header, in s");
  }
  std::vector<double> new_zeros;
  if (table.has("zero")) {
    const auto zeros = table.column<std::uint16_t>("zero");
    for (std::size_t i = 0; i < zeros.size(); ++i) {
      if (zeros[i] != (i == 0 ? 0 : zeros[i - 1])) new_zeros.push_back(times[i]);
    }
  }
  return {epoch_of(table), std::move(times), std::move(angles), max_gap, std::move(new_zeros)};
}

PlateTrajectory trajectory_between(const PcdTable& measurements, double max_gap) {
  const auto times = measurements.column<double>("time");
  const auto angles = measurements.column<double>("plate_angle");
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](auto i) { return !std::isfinite(times[i]) || !std::isfinite(angles[i]); });
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return times[a] < times[b]; });

  std::vector<double> knots;
  std::vector<double> unwrapped;
  for (const auto i : order) {
    if (!knots.empty() && times[i] == knots.back()) continue;
    const double step = unwrapped.empty() ? 0 : angles[i] - unwrapped.back();
    knots.push_back(times[i]);
    unwrapped.push_back(angles[i] - 2 * std::numbers::pi * std::round(step / (2 * std::numbers::pi)));
  }
  if (knots.size() < 2)
    throw Error(fmt::format("the measurements hold plate angles at {} times", knots.size()),
                "give measurements with plate angles at two times or more, or the file NAME.plate.pcd");
  return {epoch_of(measurements), std::move(knots), std::move(unwrapped), max_gap};
}

}  // namespace crisp
