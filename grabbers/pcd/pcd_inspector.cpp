// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/pcd_inspector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/pcd_table.hpp>

namespace crisp::pcd_grabber {
namespace {

/// The numbers of a column that are numbers.
struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  std::size_t not_finite = 0;

  explicit Extent(const std::vector<double>& values) {
    for (const double value : values) {
      if (!std::isfinite(value)) {
        ++not_finite;
        continue;
      }
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
};

const char* format_of(PcdFormat format) {
  switch (format) {
    case PcdFormat::ascii:
      return "ascii";
    case PcdFormat::binary:
      return "binary";
    case PcdFormat::binary_compressed:
      return "binary_compressed";
  }
  return "";
}

void add_field(const PcdTable& table, const PcdField& field, Inspection& inspection) {
  const std::string type = fmt::format("{}{}", field.type, 8 * field.size);
  auto& data = inspection.data["fields"][field.name];
  data = {{"type", type}, {"count", field.count}};
  inspection.text += fmt::format("\n  {:<16}{:<6}", field.name, type);
  if (field.count != 1 || table.rows() == 0) return;
  const Extent extent(table.column<double>(field.name));
  if (extent.least <= extent.most) {
    data["least"] = extent.least;
    data["most"] = extent.most;
    inspection.text += fmt::format("{:>16.8g} {:>16.8g}", extent.least, extent.most);
  }
  if (extent.not_finite == 0) return;
  data["not_finite"] = extent.not_finite;
  inspection.text += fmt::format("   {} are no numbers", extent.not_finite);
}

Inspection inspect(const std::filesystem::path& file, const Rig&) {
  const PcdTable table = read_pcd(file);
  Inspection inspection;
  inspection.text = fmt::format("  {} points, {}\n  {:<16}{:<6}{:>16} {:>16}", table.rows(),
                                format_of(table.header().format), "field", "type", "least", "most");
  inspection.data = {{"points", table.rows()}, {"format", format_of(table.header().format)}};
  if (table.surplus() > 0) {
    inspection.text += fmt::format("\n  {} more points follow those that POINTS counts", table.surplus());
    inspection.data["surplus_points"] = table.surplus();
  }
  for (const PcdField& field : table.header().fields) add_field(table, field, inspection);
  for (const auto& [key, value] : table.header().notes) {
    inspection.text += fmt::format("\n  {}: {}", key, value);
    inspection.data["notes"][key] = value;
  }
  return inspection;
}

/// By the line that names the fields: comments of any kind and length may stand before it.
bool recognises(std::string_view head) {
  return head.starts_with("# .PCD") || head.starts_with("VERSION ") ||
         head.find("\nFIELDS ") != std::string_view::npos;
}

}  // namespace

Inspector pcd_inspector() { return {"a cloud", recognises, inspect, {".pcd"}}; }

}  // namespace crisp::pcd_grabber
