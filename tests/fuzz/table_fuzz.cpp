// SPDX-License-Identifier: BSD-3-Clause
// Tables: whatever the bytes are, rows of finite numbers, or counted losses.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include <crisp/error.hpp>

#include "grabbers/table/table_items.hpp"
#include "grabbers/table/table_reader.hpp"

namespace crisp {
namespace {

using namespace crisp::table;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Whether all rows were read: a table with decimal commas is refused.
bool read_rows(TableReader& reader, TableItems& items) {
  try {
    while (const auto row = reader.next()) {
      require(std::isfinite(row->angle) && std::isfinite(row->mirror));
      for (const float range : row->ranges) require(range >= 0 && std::isfinite(range));
      items.add(*row);
    }
  } catch (const Error&) {
    return false;
  }
  return true;
}

void read(const std::string& text, const TableFormat& format) {
  std::istringstream in(text);
  TableReader reader(in, "table.csv", format);
  const TableScanSettings settings{.angle_step = 0.01, .beam_interval = 1e-5};
  TableItems items(format, settings, default_rig());
  if (!read_rows(reader, items)) return;
  require(reader.losses().empty() == !reader.first_fault());
  for (const auto& beams : items.take_measurements()) {
    for (std::size_t i = 0; i < beams->size(); ++i) {
      require(beams->range[i] > 0 && std::isfinite(beams->time[i]) && beams->laser[i] < 3);
    }
  }
  try {
    items.trajectory();
  } catch (const Error&) {
    return;  // fewer than two angles
  }
}

}  // namespace
}  // namespace crisp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  crisp::read(text, {.time_column = 1, .angle_column = 2, .range_column = 3});
  crisp::read(text, {.receipt_column = 1,
                     .receipt_unit = crisp::table::TimeUnit::ns,
                     .counter_column = 2,
                     .counter_modulus = 256,
                     .period = 0.01,
                     .angle_column = 3,
                     .angle_unit = crisp::AngleUnit::deg,
                     .range_column = 5,
                     .count_column = 4,
                     .range_unit = crisp::table::LengthUnit::cm,
                     .invalid_from = 8183});
  crisp::read(text, {.time_column = 1,
                     .angle_column = 2,
                     .range_column = 5,
                     .remission_column = 6,
                     .mirror_column = 4,
                     .laser_column = 3});
  return 0;
}
