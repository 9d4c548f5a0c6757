// SPDX-License-Identifier: BSD-3-Clause
// Calibration of any rig: tests/independent draws rigs, scenes, motions, clocks and mistakes from seeds, and
// configs/calibrate.yaml gets the capture and the rig's file. Prints a line for each draw, and in the end how
// many were right and trusted, which mistakes were reported, and the coverage of the standard errors.
//
//     rig_trial FIRST DRAWS [NAME=VALUE...]      as independent_scanner has them: fault=mount, duration=8
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <crisp/calibration_file.hpp>

#include "tests/end_to_end/drawn_rig.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

class RigTrial {
 public:
  void run(std::uint64_t seed, const std::vector<std::string>& fixed) {
    const test::PipelineFixture fixture;
    const test::DrawnRig drawn(fixture / "drawn", seed, fixed);
    const auto begin = std::chrono::steady_clock::now();
    const auto outcome = fixture.run("calibrate.yaml", drawn.capture(), "out", {}, drawn.rig());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::string verdict = outcome.status == ExitStatus::done ? "trusted" : "untrusted";
    std::vector<std::string> wrong;
    if (std::ranges::count(outcome.files, "calibration.yaml") == 0) {
      verdict = "refused";
    } else {
      for (const auto& parameter : drawn.compare(read_calibration(fixture / "out/calibration.yaml"))) {
        if (parameter.is_wrong()) {
          wrong.push_back(
              fmt::format("{} {:.1f} s.e.", parameter.name, std::abs(parameter.error) / parameter.std_error));
        }
        if (drawn.fault() != "none" || outcome.status != ExitStatus::done || !parameter.free) continue;
        scores_[parameter.name.substr(parameter.name.rfind('.') + 1)].push_back(parameter.error /
                                                                                parameter.std_error);
      }
      verdict = (wrong.empty() ? "right, " : "wrong, ") + verdict;
    }
    ++verdicts_[drawn.fault()][verdict];
    fmt::print("{:<5} {:<9} {:<17} {:.0f} s; {}; {}\n", seed, drawn.fault(), verdict, took.count(),
               drawn.words(), fmt::join(wrong, ", "));
    if (outcome.status != ExitStatus::done) print_reasons(outcome.console);
    std::fflush(stdout);
  }

  void print() const {
    fmt::print("\n");
    for (const auto& [fault, verdicts] : verdicts_) {
      fmt::print("{}:", fault);
      for (const auto& [verdict, draws] : verdicts) fmt::print("  {} {}", draws, verdict);
      fmt::print("\n");
    }
    for (const auto& [kind, scores] : scores_) {
      const auto within = [&scores = scores](double errors) {
        return 100.0 *
               static_cast<double>(
                   std::ranges::count_if(scores, [&](double score) { return std::abs(score) < errors; })) /
               static_cast<double>(scores.size());
      };
      fmt::print("{:<6} {:>5} trusted, within 1 s.e. {:.0f} %, 1.96 s.e. {:.0f} %\n", kind, scores.size(),
                 within(1), within(1.96));
    }
  }

 private:
  static void print_reasons(const std::string& console) {
    std::size_t begin = 0;
    while (begin < console.size()) {
      const std::size_t end = std::min(console.find('\n', begin), console.size());
      const std::string line = console.substr(begin, end - begin);
      if (line.starts_with("untrusted") || line.find("error: ") != std::string::npos)
        fmt::print("      {}\n", line);
      begin = end + 1;
    }
  }

  std::map<std::string, std::map<std::string, int>> verdicts_;  // by fault
  std::map<std::string, std::vector<double>> scores_;           // errors in standard errors, by kind
};

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  if (arguments.size() < 3) {
    fmt::print(stderr, "usage: rig_trial FIRST DRAWS [NAME=VALUE...]\n");
    return 2;
  }
  const std::uint64_t first = std::strtoull(arguments[1], nullptr, 10);
  const std::uint64_t draws = std::strtoull(arguments[2], nullptr, 10);
  const std::vector<std::string> fixed(arguments.begin() + 3, arguments.end());
  try {
    crisp::RigTrial trial;
    for (std::uint64_t seed = first; seed < first + draws; ++seed) trial.run(seed, fixed);
    trial.print();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
