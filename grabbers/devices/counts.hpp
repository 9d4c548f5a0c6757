// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace crisp {

/// Events, mostly losses, by a name that a person understands: "packets cut short by the capture".
class Counts {
 public:
  void add(std::string_view name, std::uint64_t n = 1) {
    if (n == 0) return;
    const auto found = counts_.find(name);
    if (found != counts_.end()) {
      found->second += n;
    } else {
      counts_.emplace(name, n);
    }
  }
  void add(const Counts& other) {
    for (const auto& [name, n] : other.counts_) add(name, n);
  }
  std::uint64_t of(std::string_view name) const {
    const auto found = counts_.find(name);
    return found == counts_.end() ? 0 : found->second;
  }
  const std::map<std::string, std::uint64_t, std::less<>>& all() const { return counts_; }
  bool operator==(const Counts&) const = default;

 private:
  std::map<std::string, std::uint64_t, std::less<>> counts_;
};

}  // namespace crisp
