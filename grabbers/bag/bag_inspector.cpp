// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_inspector.hpp"

#include "grabbers/bag/bag_file.hpp"
#include "grabbers/bag/bag_summary.hpp"

namespace crisp::bag {
namespace {

Inspection inspect_bag(const std::filesystem::path& file, const Rig&) {
  BagFile bag(file);
  const BagSummary summary = summarize(bag.reader());
  return {.text = to_text(summary), .data = to_json(summary)};
}

}  // namespace

Inspector bag_inspector() { return {"a bag", is_bag, inspect_bag, bag_extensions()}; }

}  // namespace crisp::bag
