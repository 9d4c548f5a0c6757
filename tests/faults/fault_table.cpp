// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/fault_table.hpp"

#include <fmt/format.h>

#include <numeric>

namespace crisp::test {
namespace {

constexpr const char* kColumns =
    "faults | survived | refused (exit 2) | failed (exit 1) | untrusted (exit 3) | killed | guarantee broken |\n";

}  // namespace

void FaultTable::add(const std::string& scenario, const std::string& call, const std::string& fault,
                     const Verdict& verdict) {
  add(by_call_[{scenario, call}], verdict);
  add(by_fault_[fault], verdict);
}

void FaultTable::add(Row& row, const Verdict& verdict) {
  ++row.ends.at(static_cast<std::size_t>(verdict.end));
  if (!verdict.violations.empty()) ++row.violations;
}

std::size_t FaultTable::faults_in(const Row& row) {
  return std::accumulate(row.ends.begin(), row.ends.end(), std::size_t{0});
}

std::size_t FaultTable::faults() const {
  std::size_t sum = 0;
  for (const auto& [fault, row] : by_fault_) sum += faults_in(row);
  return sum;
}

std::string FaultTable::text(const Row& row) {
  return fmt::format(" {} | {} | {} | {} | {} | {} | {} |\n", faults_in(row), row.ends[0], row.ends[1],
                     row.ends[2], row.ends[3], row.ends[4], row.violations);
}

std::string FaultTable::text() const {
  std::string table = fmt::format("| scenario | call | {}|---|---|---|---|---|---|---|---|---|\n", kColumns);
  for (const auto& [key, row] : by_call_)
    table += fmt::format("| {} | {} |{}", key.first, key.second, text(row));
  table += fmt::format("\n| fault | {}|---|---|---|---|---|---|---|---|\n", kColumns);
  for (const auto& [fault, row] : by_fault_) table += fmt::format("| {} |{}", fault, text(row));
  return table;
}

}  // namespace crisp::test
