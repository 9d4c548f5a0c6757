// SPDX-License-Identifier: BSD-3-Clause
// Accuracy of calibrations of whole captures: each capture is simulated from a seed, and
// configs/calibrate.yaml gets nothing else. Prints a line for each capture and a summary: errors next to the
// calibration's own standard errors, and the RQE of the refinement and of the truth.
//
//     calibration_trial [SCENE [CAPTURES [FIRST]]]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <crisp/calibration_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::data;

constexpr const char* kRefineTheTruth = R"(crisp: 1
vars: {calibration: ""}
pipeline:
  - stage: grabber.capture
    with: {file: "${input}"}
  - stage: clock.convex_hull
  - stage: calibrate.load
    with: {file: "${calibration}"}
  - stage: calibrate.refine
)";

/// What a parameter of one laser was found as.
struct Found {
  double error = 0;
  double by_rqe = 0;  ///< error of calibrate.rqe
  double std_error = 0;
};

struct Kind {
  const char* name;
  const char* unit;
  double scale;  ///< of the unit in SI
};
constexpr std::array<Kind, 4> kKinds = {
    {{"lambda", "deg", kDegree}, {"tau", "mm", 1e-3}, {"alpha", "deg", kDegree}, {"eta", "us", 1e-6}}};

const Parameter& of(const LaserCalibration& laser, std::size_t kind) {
  return std::array{&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}.at(kind)[0];
}

class Trial {
 public:
  void run(const std::string& scene, std::uint64_t seed) {
    const test::PipelineFixture fixture;
    fixture.simulate("made", {"scene=" + scene, fmt::format("seed={}", seed)});
    const auto outcome = fixture.run("calibrate.yaml", fixture / "made/hub.pcap", "out");
    if (!outcome.cloud) throw Error(fmt::format("seed {}: {}", seed, outcome.console));
    untrusted_ += outcome.status == ExitStatus::done ? 0 : 1;
    const Calibration truth = read_calibration(fixture / "made/truth.yaml");
    const Calibration found = read_calibration(fixture / "out/calibration.yaml");
    const auto& by_rqe = outcome.stage("calibrate.rqe")["report"]["lasers"];
    fmt::print("{:<9} seed {:<4}", scene, seed);
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
      double worst = 0;
      for (std::size_t l = 0; l < truth.lasers.size(); ++l) {
        const Parameter& is = of(found.lasers.at(l), k);
        if (!is.free) continue;
        const double was = of(truth.lasers[l], k).value;
        const double coarse = by_rqe[truth.lasers[l].name][kKinds[k].name]["value"].get<double>() - was;
        found_[k].push_back(
            {.error = turn(is.value - was, k), .by_rqe = turn(coarse, k), .std_error = is.std_error});
        worst = std::max(worst, std::abs(found_[k].back().error));
      }
      fmt::print("  {} {:.3f} {}", kKinds[k].name, worst / kKinds[k].scale, kKinds[k].unit);
    }
    judge(fixture, outcome.stage("calibrate.refine")["report"]["quality"]);
    fmt::print("{}\n", outcome.status == ExitStatus::done ? "" : "; untrusted");
    std::fflush(stdout);
  }

  void print() const {
    fmt::print("\n{:<8} {:>28} {:>20} {:>12} {:>22}\n", "", "calibrate.rqe: rms, worst",
               "refined: rms, worst", "rms of s.e.", "within 1, 1.96 s.e.");
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
      const double unit = kKinds[k].scale;
      const auto within = [&](double errors) {
        return 100.0 *
               static_cast<double>(std::ranges::count_if(
                   found_[k], [&](const Found& f) { return std::abs(f.error) < errors * f.std_error; })) /
               static_cast<double>(found_[k].size());
      };
      fmt::print("{:<6} {:<3} {:>18.3f} {:>8.3f} {:>11.4f} {:>8.4f} {:>12.4f} {:>12.1f} % {:>5.1f} %\n",
                 kKinds[k].name, kKinds[k].unit, rms(k, &Found::by_rqe) / unit,
                 worst(k, &Found::by_rqe) / unit, rms(k, &Found::error) / unit,
                 worst(k, &Found::error) / unit, rms(k, &Found::std_error) / unit, within(1), within(1.96));
    }
    fmt::print("{} captures, {} of them with an untrusted calibration\n", gains_.size(), untrusted_);
    print("RQE, refined less unrefined", gains_);
    print("RQE, refined less the truth's", behind_truth_);
  }

 private:
  static double turn(double difference, std::size_t kind) {
    return kind == 0 ? std::remainder(difference, 2 * std::numbers::pi) : difference;
  }

  /// Compares the RQE of the refined calibration with that before and with that of the truth.
  void judge(const test::PipelineFixture& fixture, const nlohmann::json& quality) {
    const auto rqe = [](const nlohmann::json& all, const char* which) { return all.at(which).get<double>(); };
    gains_.push_back(rqe(quality, "rqe_after") - rqe(quality, "rqe_unrefined"));
    std::ofstream(fixture / "truth_refined.yaml") << kRefineTheTruth;
    const auto outcome = fixture.run((fixture / "truth_refined.yaml").string(), fixture / "made/hub.pcap",
                                     "judged", {"calibration=" + (fixture / "made/truth.yaml").string()});
    if (outcome.summary.is_null()) throw Error(outcome.console);
    const auto& of_truth = outcome.stage("calibrate.refine")["report"]["quality"];
    behind_truth_.push_back(rqe(of_truth, "rqe_after") - rqe(of_truth, "rqe_unrefined"));
    fmt::print("  RQE {:+.4f}, to the truth {:+.4f} nat", gains_.back(), behind_truth_.back());
  }

  static void print(const char* what, std::vector<double> differences) {
    std::ranges::sort(differences);
    fmt::print("{}: {:+.4f} to {:+.4f} nat, in the middle {:+.4f}; less in {} of {}\n", what,
               differences.front(), differences.back(), differences[differences.size() / 2],
               std::ranges::count_if(differences, [](double d) { return d < 0; }), differences.size());
  }

  double rms(std::size_t kind, double Found::*part) const {
    double squares = 0;
    for (const Found& found : found_[kind]) squares += found.*part * found.*part;
    return std::sqrt(squares / static_cast<double>(found_[kind].size()));
  }
  double worst(std::size_t kind, double Found::*part) const {
    double most = 0;
    for (const Found& found : found_[kind]) most = std::max(most, std::abs(found.*part));
    return most;
  }

  std::array<std::vector<Found>, kKinds.size()> found_;
  std::vector<double> gains_;
  std::vector<double> behind_truth_;
  int untrusted_ = 0;
};

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  const std::string scene = arguments.size() > 1 ? arguments[1] : "office";
  const auto number = [&](std::size_t at, std::uint64_t otherwise) {
    return arguments.size() > at ? std::strtoull(arguments[at], nullptr, 10) : otherwise;
  };
  try {
    crisp::Trial trial;
    const std::uint64_t first = number(3, 1);
    for (std::uint64_t seed = first; seed < first + number(2, 10); ++seed) trial.run(scene, seed);
    trial.print();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
