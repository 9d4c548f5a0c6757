// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/fault_table.hpp"

#include <fmt/format.h>

namespace crisp::test {

void FaultTable::add(const std::string& call, const std::string& fault, const Verdict& verdict) {
  Row& row = rows_[{call, fault}];
  ++row.ends.at(static_cast<std::size_t>(verdict.end));
  if (!verdict.violations.empty()) ++row.violations;
}

std::size_t FaultTable::faults() const {
  std::size_t sum = 0;
  for (const auto& [key, row] : rows_) {
    for (const std::size_t count : row.ends) sum += count;
  }
  return sum;
}

std::string FaultTable::text() const {
  std::string text =
      "| call | fault | survived | refused (exit 2) | failed (exit 1) | untrusted (exit 3) | killed | "
      "guarantee broken |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const auto& [key, row] : rows_) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", key.first, key.second, row.ends[0],
                        row.ends[1], row.ends[2], row.ends[3], row.ends[4], row.violations);
  }
  return text;
}

}  // namespace crisp::test
