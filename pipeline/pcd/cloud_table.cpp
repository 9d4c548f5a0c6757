// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pcd/cloud_table.hpp"

#include <cmath>
#include <cstdint>

namespace crisp {
namespace {

constexpr std::int64_t kNsPerUs = 1000;

template <PcdNumber T>
std::vector<T> column_or_zeros(const PcdTable& table, std::string_view field) {
  return table.has(field) ? table.column<T>(field) : std::vector<T>(table.rows());
}

}  // namespace

PcdTable to_table(const Cloud& cloud) {
  PcdTable table(cloud.size());
  table.set_note("epoch_ns", std::to_string(static_cast<std::int64_t>(cloud.header.stamp) * kNsPerUs));
  table.add<float>("x", [&](std::size_t i) { return cloud[i].x; });
  table.add<float>("y", [&](std::size_t i) { return cloud[i].y; });
  table.add<float>("z", [&](std::size_t i) { return cloud[i].z; });
  table.add<float>("intensity", [&](std::size_t i) { return cloud[i].intensity; });
  table.add<std::uint16_t>("laser", [&](std::size_t i) { return cloud[i].laser; });
  table.add<std::uint16_t>("beam", [&](std::size_t i) { return cloud[i].beam; });
  table.add<double>("time", [&](std::size_t i) { return cloud[i].time; });
  return table;
}

TableCloud cloud_of(const PcdTable& table) {
  const auto x = table.column<float>("x");
  const auto y = table.column<float>("y");
  const auto z = table.column<float>("z");
  const auto intensity = column_or_zeros<float>(table, "intensity");
  const auto laser = column_or_zeros<std::uint16_t>(table, "laser");
  const auto beam = column_or_zeros<std::uint16_t>(table, "beam");
  const auto time = column_or_zeros<double>(table, "time");

  TableCloud result{.cloud = std::make_shared<Cloud>()};
  result.cloud->header.stamp =
      static_cast<std::uint64_t>(table.header().note<std::int64_t>("epoch_ns").value_or(0) / kNsPerUs);
  result.cloud->reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]) || !std::isfinite(z[i]) || !std::isfinite(time[i])) {
      ++result.not_finite;
      continue;
    }
    Point point;
    point.x = x[i];
    point.y = y[i];
    point.z = z[i];
    point.intensity = intensity[i];
    point.laser = laser[i];
    point.beam = beam[i];
    point.time = time[i];
    result.cloud->push_back(point);
  }
  return result;
}

}  // namespace crisp
