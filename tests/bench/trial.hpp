// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace crisp::test {

/// How often each verdict was reached, by kind of draw.
class VerdictTable {
 public:
  void count(const std::string& kind, const std::string& verdict) { ++counts_[kind][verdict]; }

  void print() const {
    for (const auto& [kind, verdicts] : counts_) {
      fmt::print("{}:", kind);
      for (const auto& [verdict, draws] : verdicts) fmt::print("  {} {}", draws, verdict);
      fmt::print("\n");
    }
  }

 private:
  std::map<std::string, std::map<std::string, std::size_t>> counts_;
};

/// The program of a trial, `NAME FIRST DRAWS [REST...]`: a Trial of the REST runs with the DRAWS seeds from
/// FIRST on, and prints what it counted.
template <typename Trial>
int run_trial(int argc, char** argv, const char* usage, std::size_t fewest_of_rest = 0) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  const bool is_complete = arguments.size() >= 3 + fewest_of_rest;
  const std::uint64_t first = is_complete ? std::strtoull(arguments[1], nullptr, 10) : 0;
  const std::uint64_t draws = is_complete ? std::strtoull(arguments[2], nullptr, 10) : 0;
  if (draws == 0) {
    fmt::print(stderr, "usage: {}\n", usage);
    return 2;
  }
  try {
    Trial trial({arguments.begin() + 3, arguments.end()});
    for (std::uint64_t seed = first; seed < first + draws; ++seed) {
      trial.run(seed);
      std::fflush(stdout);
    }
    trial.print();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace crisp::test
