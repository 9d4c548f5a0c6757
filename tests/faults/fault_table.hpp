// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "tests/faults/property.hpp"

namespace crisp::test {

/// How many faults ended how: by scenario and call, and by kind of fault.
class FaultTable {
 public:
  void add(const std::string& scenario, const std::string& call, const std::string& fault,
           const Verdict& verdict);
  std::size_t faults() const;
  /// In Markdown.
  std::string text() const;

 private:
  struct Row {
    std::array<std::size_t, 5> ends{};  ///< by Verdict::End
    std::size_t violations = 0;
  };
  static void add(Row& row, const Verdict& verdict);
  static std::size_t faults_in(const Row& row);
  static std::string text(const Row& row);

  std::map<std::pair<std::string, std::string>, Row> by_call_;
  std::map<std::string, Row> by_fault_;
};

}  // namespace crisp::test
