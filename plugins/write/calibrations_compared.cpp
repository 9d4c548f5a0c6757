// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/calibrations_compared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "pipeline/data/each_parameter.hpp"
#include "pipeline/data/shown_unit.hpp"

namespace crisp::write {
namespace {

/// One parameter of two calibrations, of which one may lack it.
struct Row {
  std::string name;
  const Parameter* first = nullptr;
  const Parameter* second = nullptr;
};

/// In the order of the first, then what only the second has.
std::vector<Row> rows_of(const Calibration& first, const Calibration& second) {
  std::vector<Row> rows;
  data::for_each_parameter(first, [&](const std::string& name, const Parameter& p) {
    rows.push_back({.name = name, .first = &p});
  });
  data::for_each_parameter(second, [&](const std::string& name, const Parameter& p) {
    const auto same = std::ranges::find(rows, name, &Row::name);
    if (same == rows.end())
      rows.push_back({.name = name, .second = &p});
    else
      same->second = &p;
  });
  return rows;
}

/// With so many digits behind the point that an error of this size has two that count.
std::string figure(double value, double error) {
  constexpr int kUnknown = 4;
  constexpr int kMax = 9;
  const int digits = error > 0 ? data::decimals_that_show(error) : kUnknown;
  return fmt::format("{:.{}f}", value, std::clamp(digits, 0, kMax));
}

std::string line_of(const Row& row) {
  const Parameter& known = row.first ? *row.first : *row.second;
  const data::ShownUnit unit = data::shown_unit(known.unit);
  // For independent recordings: for one and the same, the difference is less.
  const double error =
      unit.factor * std::hypot(row.first ? row.first->std_error : 0, row.second ? row.second->std_error : 0);
  const auto shown = [&](const Parameter* p) { return p ? figure(unit.factor * p->value, error) : "-"; };
  std::string difference = "-";
  std::string in_errors;
  if (row.first && row.second) {
    double by = row.second->value - row.first->value;
    if (known.unit == "rad") by = std::remainder(by, 2 * std::numbers::pi);
    difference = figure(unit.factor * by, error);
    if (error > 0) in_errors = fmt::format("{:>12.1f}", unit.factor * by / error);
  }
  return fmt::format("\n  {:<36}{:<5}{:>14}{:>14}{:>14}{}", row.name, unit.name, shown(row.first),
                     shown(row.second), difference, in_errors);
}

std::string quality_line(const std::string& name, const Calibration& first, const Calibration& second) {
  const auto shown = [&](const Calibration& calibration) {
    const auto found = calibration.quality.find(name);
    return found == calibration.quality.end() ? "-" : fmt::format("{:.5g}", found->second);
  };
  return fmt::format("\n  {:<36}{:<5}{:>14}{:>14}", name, "", shown(first), shown(second));
}

std::string caveats_of(const char* which, const Calibration& calibration) {
  std::string text;
  for (const auto& caveat : calibration.caveats)
    text += fmt::format("\n  the {} is UNTRUSTED: {}", which, caveat);
  return text;
}

}  // namespace

std::string compare_calibrations(const Calibration& first, const Calibration& second) {
  std::string text = fmt::format("  {:<36}{:<5}{:>14}{:>14}{:>14}{:>12}", "parameter", "unit", "first",
                                 "second", "difference", "std errors");
  for (const Row& row : rows_of(first, second)) text += line_of(row);
  std::set<std::string> figures;
  for (const auto* calibration : {&first, &second}) {
    for (const auto& [name, value] : calibration->quality) figures.insert(name);
  }
  for (const auto& name : figures) text += quality_line(name, first, second);
  return text + caveats_of("first", first) + caveats_of("second", second);
}

}  // namespace crisp::write
