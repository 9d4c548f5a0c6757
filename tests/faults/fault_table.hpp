// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>

#include "tests/faults/property.hpp"

namespace crisp::test {

/// How many faults ended how, by call and kind of fault.
class FaultTable {
 public:
  void add(const std::string& call, const std::string& fault, const Verdict& verdict);
  std::size_t faults() const;
  /// In Markdown.
  std::string text() const;

 private:
  struct Row {
    std::array<std::size_t, 5> ends{};  ///< by Verdict::End
    std::size_t violations = 0;
  };
  std::map<std::pair<std::string, std::string>, Row> rows_;
};

}  // namespace crisp::test
