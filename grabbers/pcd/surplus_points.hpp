// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <filesystem>

#include <crisp/context.hpp>
#include <crisp/pcd_table.hpp>

namespace crisp::pcd_grabber {

/// Counts points that stand in a file behind those that its header gives, and warns of them.
inline void count_surplus(const PcdTable& table, const std::filesystem::path& file, Context& context) {
  context.count("points beyond the header's count", table.surplus());
  if (table.surplus() == 0) return;
  context.warn(fmt::format(
      "{}: {} points follow the {} that POINTS counts, and were not read; correct WIDTH and POINTS if they belong to the cloud",
      file.string(), table.surplus(), table.rows()));
}

}  // namespace crisp::pcd_grabber
