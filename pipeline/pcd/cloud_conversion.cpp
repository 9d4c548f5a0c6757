// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include <crisp/cloud_conversion.hpp>

namespace crisp {
namespace {

constexpr std::int64_t kNsPerUs = 1000;

constexpr std::array<std::string_view, 7> kKept = {"x", "y", "z", "intensity", "laser", "beam", "time"};

bool is_same_letter(unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); }

bool mentions_time(std::string_view name) {
  constexpr std::string_view kTime = "time";
  return std::search(name.begin(), name.end(), kTime.begin(), kTime.end(), is_same_letter) != name.end();
}

/// The table's name of a field: other programs write X or Intensity. The name itself if there
/// is none.
std::string_view own_name(const PcdTable& table, std::string_view field) {
  if (table.has(field)) return field;
  for (const auto& own : table.header().fields) {
    if (std::ranges::equal(own.name, field, is_same_letter)) return own.name;
  }
  return field;
}

template <PcdNumber T>
std::vector<T> column_or_zeros(const PcdTable& table, std::string_view field) {
  const std::string_view name = own_name(table, field);
  return table.has(name) ? table.column<T>(name) : std::vector<T>(table.rows());
}

/// A coordinate, less `by`, as a cloud holds it; `rounding` becomes the most that one changed by that.
std::vector<float> shifted_column(const PcdTable& table, std::string_view field, double by,
                                  double& rounding) {
  const auto exact = table.column<double>(own_name(table, field));
  std::vector<float> column;
  column.reserve(exact.size());
  for (const double value : exact) {
    const double shifted = value - by;
    column.push_back(static_cast<float>(shifted));
    const double change = std::abs(shifted - static_cast<double>(column.back()));
    if (std::isfinite(change)) rounding = std::max(rounding, change);
  }
  return column;
}

}  // namespace

PcdTable to_pcd_table(const Cloud& cloud) {
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

ConvertedCloud cloud_of(const PcdTable& table, const std::array<double, 3>& shift) {
  ConvertedCloud result{.cloud = std::make_shared<Cloud>()};
  const auto shifted = [&](std::string_view field, double by) {
    return shifted_column(table, field, by, result.rounding);
  };
  const auto x = shifted("x", shift[0]);
  const auto y = shifted("y", shift[1]);
  const auto z = shifted("z", shift[2]);
  const auto intensity = column_or_zeros<float>(table, "intensity");
  const auto laser = column_or_zeros<std::uint16_t>(table, "laser");
  const auto beam = column_or_zeros<std::uint16_t>(table, "beam");
  const auto time = column_or_zeros<double>(table, "time");

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

std::vector<std::string> dropped_fields(const PcdTable& table) {
  constexpr std::string_view kPadding = "_";  // PCL's, between fields
  std::vector<std::string> lost;
  std::vector<std::string> fields;
  const auto is_kept = [&](const std::string& name) {
    return std::ranges::any_of(kKept, [&](std::string_view kept) { return own_name(table, kept) == name; });
  };
  for (const auto& field : table.header().fields) {
    if (field.name != kPadding && !is_kept(field.name)) fields.push_back(field.name);
  }
  const bool has_times = std::ranges::any_of(fields, mentions_time);
  if (!fields.empty())
    lost.push_back(
        fmt::format("the fields {}{}", fmt::join(fields, ", "),
                    has_times ? " (rename the points' times to 'time' in FIELDS to keep them)" : ""));
  if (table.header().rows > 1) lost.push_back(fmt::format("the order in {} rows", table.header().rows));
  if (table.header().has_pose) lost.emplace_back("the VIEWPOINT");
  return lost;
}

std::array<double, 3> suggested_shift(const PcdTable& table) {
  constexpr double kStep = 100;  // [m] a shift that people can write down
  std::array<double, 3> shift{};
  std::size_t axis = 0;
  for (const auto* field : {"x", "y", "z"}) {
    const auto column = table.column<double>(own_name(table, field));
    const auto first = std::ranges::find_if(column, [](double value) { return std::isfinite(value); });
    shift.at(axis++) = first == column.end() ? 0 : kStep * std::round(*first / kStep);
  }
  return shift;
}

}  // namespace crisp
