// SPDX-License-Identifier: BSD-3-Clause
// Whether the further recording that a diagnosis proposes resolves two causes at once: diagnoses recordings
// of hidden_trial's `two`, simulates the proposed one in the same place where a cause is open, and diagnoses
// both together (the second alone where the first has an effect of time, which recordings do not share).
// Prints a line for each draw, and counts in the end.
//
//     second_recording_trial FIRST DRAWS [MILLIMETRES]      RMS by which each cause changes ranges (8)
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <span>

#include "pipeline/data/degree.hpp"
#include "tests/plugins/diagnose/noise/drawn.hpp"
#include "tests/support/several_recordings.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using test::stands_for;

constexpr double kOdds = SelectionSettings{}.odds;

bool is_alone(const Hypothesis& hypothesis) {
  return hypothesis.competitors.empty() || hypothesis.competitors.front().behind >= kOdds;
}

/// What became of a hidden cause.
std::string verdict_on(const std::string& name, const Diagnosis& diagnosis) {
  std::string verdict = "missed";
  for (const Hypothesis& one : diagnosis.hypotheses) {
    if (!one.accepted || !one.candidate.is_cause()) continue;
    if (one.candidate.name == name) return is_alone(one) ? "alone" : "heads its class";
    if (stands_for(one, name)) verdict = "in a class";
  }
  if (verdict != "missed") return verdict;
  const auto limit = std::ranges::find(diagnosis.unobservable, name, &Limit::name);
  if (limit == diagnosis.unobservable.end()) return verdict;
  return std::isfinite(limit->size) ? "too small" : "absorbed";
}

bool is_named(const std::string& verdict) { return verdict == "alone" || verdict == "heads its class"; }

/// The accepted causes that stand for nothing that hides.
std::vector<std::string> wrong_names(const Diagnosis& diagnosis, const std::vector<std::string>& hidden) {
  std::vector<std::string> wrong;
  for (const Hypothesis& one : diagnosis.hypotheses) {
    if (!one.accepted || !one.candidate.is_cause()) continue;
    const bool right = std::ranges::any_of(
        hidden, [&](const std::string& name) { return one.candidate.name == name || stands_for(one, name); });
    if (!right) wrong.push_back(one.candidate.name);
  }
  return wrong;
}

/// The proposal that answers most of what is open; nothing if none answers anything.
std::optional<std::size_t> best_proposal(const Diagnosis& diagnosis) {
  std::size_t most = 0;
  std::optional<std::size_t> best;
  for (std::size_t p = 0; p < diagnosis.proposals.size(); ++p) {
    std::size_t answers = 0;
    const auto one = std::vector{diagnosis.proposals[p]};
    for (const Hypothesis& h : diagnosis.hypotheses) {
      if (!h.accepted || !h.candidate.is_cause() || is_alone(h)) continue;
      for (const EffectResolution& effect : one.front().effects)
        if (effect.cause == h.candidate.cause_name() && effect.resolvable < h.test.ranges) ++answers;
    }
    for (const Limit& limit : diagnosis.unobservable)
      if (!showing(one, limit.name, limit.size).empty()) ++answers;
    if (answers <= most) continue;
    most = answers;
    best = p;
  }
  return best;
}

double mean_rate(const PlateTrajectory& plate) {
  double sum = 0;
  for (const double rate : plate.rates()) sum += std::abs(rate) / static_cast<double>(plate.size());
  return sum / (2 * std::numbers::pi);
}

simulate::Scene tilted(simulate::Scene scene, double angle) {
  const Eigen::AngleAxisd rotation(-angle, Eigen::Vector3d::UnitX());
  if (!scene.bodies.empty()) throw Error("a scene with bodies cannot be tilted");
  for (auto& surface : scene.surfaces)
    for (auto& corner : surface.corners) corner = rotation * corner;
  return scene;
}

/// The recording that is proposed, as someone would make it: near the plan.
simulate::SimulatedMeasurements as_proposed(const std::string& proposal, const test::Drawn& drawn) {
  simulate::ScannerSettings scanner = drawn.recording.scanner;
  scanner.seed += 500'000;
  simulate::Scene scene = simulate::built_in_scene(drawn.scene);
  const double rate = mean_rate(drawn.recording.made.plate);
  const auto is_of = [&](const char* words) { return proposal.find(words) != std::string::npos; };
  if (is_of("tilted")) {
    scene = tilted(scene, 30 * data::kDegree);
  } else if (is_of("to and fro")) {
    scanner.motion = {.kind = simulate::MotionKind::reversal, .max_rate = 1.5 * rate};
  } else if (is_of("varying")) {
    scanner.motion = {.min_rate = 0.2 * rate, .max_rate = 1.8 * rate, .change_time = 2};
  } else {
    scanner.motion.min_rate *= 2;
    scanner.motion.max_rate *= 2;
  }
  return simulate::simulate_measurements(scanner, scene, built_in_terms());
}

/// Whether a cause depends on the time since the recording began, so that recordings do not share it.
bool is_of_time(const Candidate& candidate) {
  return built_in_terms().get(candidate.term.term)->info().counts_from == CountsFrom::kRunsEpoch;
}

bool has_cause_of_time(const Diagnosis& diagnosis) {
  return std::ranges::any_of(diagnosis.hypotheses,
                             [](const Hypothesis& one) { return one.accepted && is_of_time(one.candidate); });
}

Diagnosis diagnosed(const test::Drawn& drawn,
                    const std::vector<simulate::SimulatedMeasurements>& recordings) {
  const test::Several all = test::several(recordings);
  return diagnose::diagnose(SensorModel(nominal_calibration(drawn.recording.scanner.rig), built_in_terms()),
                            all.sample(), built_in_terms(), {});
}

class Trial {
 public:
  void run(std::uint64_t seed, double size) {
    const test::Drawn drawn = test::Drawer(seed).with(test::some_causes(2, seed), size);
    if (!drawn.reaches(size)) return;
    const auto begin = std::chrono::steady_clock::now();
    const Diagnosis first = test::diagnosed(drawn.recording);
    std::map<std::string, std::string> verdicts;
    for (const std::string& name : drawn.names) verdicts[name] = verdict_on(name, first);
    fmt::print("{} {} {} lasers {}: {}", seed, drawn.scene, drawn.recording.scanner.rig.lasers.size(),
               drawn.motion, fmt::join(verdicts, ", "));
    count("first", verdicts, wrong_names(first, drawn.names));
    const auto best = best_proposal(first);
    const auto is_open = [](const auto& each) { return each.second != "alone"; };
    if (std::ranges::any_of(verdicts, is_open) && best) {
      const std::string& proposal = first.proposals[*best].recording;
      const auto second = as_proposed(proposal, drawn);
      const bool is_by_itself = has_cause_of_time(first);
      const Diagnosis then =
          diagnosed(drawn, is_by_itself ? std::vector{second} : std::vector{drawn.recording.made, second});
      for (auto& each : verdicts) {
        const bool is_untested = std::ranges::any_of(
            then.unshared, [&](const std::string& one) { return each.first.ends_with(one); });
        const bool is_known = is_by_itself && each.second == "alone";
        if (!is_untested && !is_known) each.second = verdict_on(each.first, then);
      }
      fmt::print("; with {}: {}", proposal, fmt::join(verdicts, ", "));
      count("second", verdicts, wrong_names(then, drawn.names));
    } else {
      count("second", verdicts, wrong_names(first, drawn.names));
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    fmt::print("; {:.0f} s\n", seconds.count());
    std::fflush(stdout);
  }

  void print() const {
    for (const auto& [what, counts] : counts_) {
      fmt::print("{}:", what);
      for (const auto& [verdict, draws] : counts) fmt::print("  {} {}", draws, verdict);
      fmt::print("\n");
    }
  }

 private:
  void count(const std::string& what, const std::map<std::string, std::string>& verdicts,
             const std::vector<std::string>& wrong) {
    auto& counts = counts_[what];
    ++counts["draws"];
    if (!wrong.empty()) {
      ++counts["with a wrong name"];
      fmt::print(" WRONG {}", fmt::join(wrong, ", "));
    }
    if (std::ranges::all_of(verdicts, [](const auto& each) { return is_named(each.second); }))
      ++counts["all named"];
    for (const auto& [name, verdict] : verdicts) ++counts[verdict];
  }

  std::map<std::string, std::map<std::string, std::size_t>> counts_;
};

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  if (arguments.size() < 3) {
    fmt::print(stderr, "usage: second_recording_trial FIRST DRAWS [MILLIMETRES]\n");
    return 2;
  }
  const std::uint64_t first = std::strtoull(arguments[1], nullptr, 10);
  const std::uint64_t draws = std::strtoull(arguments[2], nullptr, 10);
  const double size = arguments.size() > 3 ? std::strtod(arguments[3], nullptr) / 1e3 : 0.008;
  try {
    crisp::Trial trial;
    for (std::uint64_t seed = first; seed < first + draws; ++seed) trial.run(seed, size);
    trial.print();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
