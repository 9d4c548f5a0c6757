// SPDX-License-Identifier: BSD-3-Clause
// Calibration of any rig: tests/independent draws rigs, scenes, motions, clocks and mistakes from seeds, and
// configs/calibrate.yaml gets the capture and the rig's file. Prints a line for each draw, and in the end how
// many were right and trusted, which mistakes were reported, the coverage of the standard errors, and whether
// configs/bound.yaml predicted from the rig's file what would be determined.
//
//     rig_trial FIRST DRAWS [NAME=VALUE...]      as independent_scanner has them: fault=mount, duration=8
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <crisp/calibration_file.hpp>

#include "pipeline/data/degree.hpp"
#include "tests/bench/trial.hpp"
#include "tests/end_to_end/drawn_rig.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::data;

/// What study.bound expects of a recording with this rig.
struct Expected {
  std::string problem;               // with which study.bound ended
  std::vector<std::string> names;    // of all parameters but the gauge
  std::vector<std::string> unknown;  // those that are not determined
  double tau = 0;                    // m, largest standard error
  double angle = 0;                  // rad, the same of lambda and alpha

  bool is_gauge(const std::string& name) const { return std::ranges::count(names, name) == 0; }
  bool is_good() const { return problem.empty() && unknown.empty() && tau < 2e-3 && angle < 0.3 * kDegree; }
  std::string text() const {
    if (!problem.empty()) return "bound: " + problem;
    if (!unknown.empty()) return fmt::format("bound: not {}", fmt::join(unknown, ", "));
    return fmt::format("bound: {:.2f} mm, {:.3f} deg", tau * 1e3, angle / kDegree);
  }
};

Expected expect(const test::PipelineFixture& fixture, const test::DrawnRig& drawn) {
  std::vector<std::string> set = {"study.bound.refine=false"};
  for (const auto& option : drawn.plan()) set.push_back("study.bound." + option);
  const auto outcome = fixture.run("bound.yaml", {}, "bound", set, drawn.rig());
  Expected expected;
  if (outcome.summary.is_null() || outcome.status != ExitStatus::done) {
    expected.problem = outcome.console.substr(0, outcome.console.find('\n'));
    return expected;
  }
  for (const auto& [name, entry] : outcome.stage("study.bound").at("report").at("parameters").items()) {
    expected.names.push_back(name);
    if (!entry.contains("std_error_with_steps")) {
      expected.unknown.push_back(name);
      continue;
    }
    const auto error = entry.at("std_error_with_steps").get<double>();
    if (name.ends_with(".eta")) continue;
    double& largest = name.ends_with(".tau") ? expected.tau : expected.angle;
    largest = std::max(largest, error);
  }
  return expected;
}

class RigTrial {
 public:
  explicit RigTrial(std::vector<std::string> fixed) : fixed_(std::move(fixed)) {}

  void run(std::uint64_t seed) {
    const test::PipelineFixture fixture;
    const test::DrawnRig drawn(fixture / "drawn", seed, fixed_);
    const Expected expected = drawn.fault() == "none" ? expect(fixture, drawn) : Expected{};
    const auto begin = std::chrono::steady_clock::now();
    const auto outcome = fixture.run("calibrate.yaml", drawn.capture(), "out", {}, drawn.rig());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::string verdict = outcome.status == ExitStatus::done ? "trusted" : "untrusted";
    std::vector<std::string> wrong, held;
    if (std::ranges::count(outcome.files, "calibration.yaml") == 0) {
      verdict = "refused";
    } else {
      for (const auto& parameter : drawn.compare(read_calibration(fixture / "out/calibration.yaml"))) {
        // A lambda that nothing bounds is the gauge.
        if (!parameter.free && !expected.is_gauge(parameter.name)) held.push_back(parameter.name);
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
    verdicts_.count(drawn.fault(), verdict);
    fmt::print("{:<5} {:<9} {:<17} {:.0f} s; {}; {}\n", seed, drawn.fault(), verdict, took.count(),
               drawn.words(), fmt::join(wrong, ", "));
    if (drawn.fault() == "none") {
      const bool is_determined = verdict != "refused" && held.empty();
      ++predicted_[{expected.problem.empty() && expected.unknown.empty(), is_determined}];
      if (expected.is_good()) verdicts_.count("bound below 2 mm and 0.3 deg", verdict);
      fmt::print("      {}", expected.text());
      if (!held.empty()) fmt::print("; held: {}", fmt::join(held, ", "));
      fmt::print("\n");
    }
    print_fit(outcome);
    if (outcome.status != ExitStatus::done) print_reasons(outcome.console);
  }

  void print() const {
    fmt::print("\n");
    verdicts_.print();
    for (const auto& [determined, draws] : predicted_) {
      fmt::print("  {} {} by the bound, {} by the calibration\n", draws,
                 determined.first ? "determined" : "not determined",
                 determined.second ? "determined" : "not determined");
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
  /// What trust in the result may rest on.
  static void print_fit(const test::Outcome& outcome) {
    if (std::ranges::count(outcome.files, "calibration.yaml") == 0) return;
    const auto& report = outcome.stage("calibrate.refine").at("report");
    double least = 1;
    for (const auto& view : report.at("views")) least = std::min(least, view.at("share").get<double>());
    fmt::print("      fit: {:.2f} of the beams on surfaces, views agree on {:.2f}",
               report.at("beams").get<double>() /
                   outcome.stage("assemble.deskew").at("report").at("points").get<double>(),
               least);
    if (report.contains("cross_validation"))
      fmt::print(", cross-validation {:.2f}", report.at("cross_validation").at("ratio").get<double>());
    const auto& quality = report.at("quality");
    fmt::print(", RQE {:.3f} nominal, {:.3f} before, {:.3f} refined\n",
               quality.at("rqe_before").get<double>(), quality.at("rqe_unrefined").get<double>(),
               quality.at("rqe_after").get<double>());
  }

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

  std::vector<std::string> fixed_;
  test::VerdictTable verdicts_;                        // by fault, and of right rigs those with a good bound
  std::map<std::pair<bool, bool>, int> predicted_;     // determined by the bound, by the calibration
  std::map<std::string, std::vector<double>> scores_;  // errors in standard errors, by kind
};

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  return crisp::test::run_trial<crisp::RigTrial>(argc, argv, "rig_trial FIRST DRAWS [NAME=VALUE...]");
}
