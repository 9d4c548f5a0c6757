// SPDX-License-Identifier: BSD-3-Clause
// Whether the further recording that a diagnosis proposes resolves two causes at once: diagnoses recordings
// of hidden_trial's `two`, simulates the proposed one where a cause is open, and diagnoses both together (the
// second alone where the first has an effect of time, which recordings do not share). Prints a line for each
// draw, and counts in the end.
//
//     second_recording_trial FIRST DRAWS [MILLIMETRES]      RMS by which each cause changes ranges (8)
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "pipeline/data/degree.hpp"
#include "tests/bench/trial.hpp"
#include "tests/plugins/diagnose/noise/drawn.hpp"
#include "tests/support/other_places.hpp"
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
    if (one.candidate.cause_name() == name) return is_alone(one) ? "alone" : "heads its class";
    if (stands_for(one, name)) verdict = "in a class";
  }
  if (verdict != "missed") return verdict;
  const auto limit = std::ranges::find(diagnosis.unobservable, name, &Limit::name);
  if (limit == diagnosis.unobservable.end()) return verdict;
  return std::isfinite(limit->size) ? "too small" : "absorbed";
}

/// The accepted causes that stand for nothing that hides.
std::vector<std::string> wrong_names(const Diagnosis& diagnosis, const std::vector<std::string>& hidden) {
  std::vector<std::string> wrong;
  for (const Hypothesis& one : diagnosis.hypotheses) {
    if (!one.accepted || !one.candidate.is_cause()) continue;
    const bool right = std::ranges::any_of(hidden, [&](const std::string& name) {
      return one.candidate.cause_name() == name || stands_for(one, name);
    });
    if (!right) wrong.push_back(one.candidate.cause_name());
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

/// The recording that is proposed, as someone would make it: near the plan.
simulate::SimulatedMeasurements as_proposed(const std::string& proposal, const test::Drawn& drawn) {
  simulate::ScannerSettings scanner = drawn.recording.scanner;
  scanner.seed += 500'000;
  simulate::Scene scene = simulate::built_in_scene(drawn.scene);
  const double rate = mean_rate(drawn.recording.made.plate);
  const auto is_of = [&](const char* words) { return proposal.find(words) != std::string::npos; };
  if (is_of("tilted")) {
    scene = test::seen_from_elsewhere(
        scene, Eigen::AngleAxisd(30 * data::kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix());
  } else if (is_of("another place")) {
    scene = test::seen_from_elsewhere(scene, Eigen::Matrix3d::Identity(), is_of("3 times") ? 3 : 1. / 3);
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

using Verdicts = std::map<std::string, std::string>;  // by hidden cause

bool are_all(const Verdicts& verdicts, const std::set<std::string>& what) {
  return std::ranges::all_of(verdicts, [&](const auto& each) { return what.contains(each.second); });
}

/// Updates the verdicts by the diagnosis of the recording that was proposed. `with_first`: together with the
/// first.
void update(Verdicts& verdicts, const Diagnosis& then, bool with_first) {
  for (auto& [name, verdict] : verdicts) {
    const bool is_untested = std::ranges::any_of(
        then.unshared, [&name = name](const std::string& unshared) { return name.ends_with(unshared); });
    const bool is_known = !with_first && verdict == "alone";
    if (!is_untested && !is_known) verdict = verdict_on(name, then);
  }
}

class Trial {
 public:
  explicit Trial(const std::vector<std::string>& rest) {
    if (!rest.empty()) size_ = std::strtod(rest.front().c_str(), nullptr) / 1e3;
  }

  void run(std::uint64_t seed) {
    const test::Drawn drawn = test::Drawer(seed).with(test::some_causes(2, seed), size_);
    if (!drawn.reaches(size_)) return;
    const auto begin = std::chrono::steady_clock::now();
    const Diagnosis first = test::diagnosed(drawn.recording);
    Verdicts verdicts;
    for (const std::string& name : drawn.names) verdicts[name] = verdict_on(name, first);
    fmt::print("{} {} {} lasers {}: {}", seed, drawn.scene, drawn.recording.scanner.rig.lasers.size(),
               drawn.motion, fmt::join(verdicts, ", "));
    count("with one", verdicts, wrong_names(first, drawn.names));
    const auto best = best_proposal(first);
    if (!are_all(verdicts, {"alone"}) && best) {
      const std::string& proposal = first.proposals[*best].recording;
      const auto second = as_proposed(proposal, drawn);
      const bool is_joint = !has_cause_of_time(first);
      const Diagnosis then =
          diagnosed(drawn, is_joint ? std::vector{drawn.recording.made, second} : std::vector{second});
      update(verdicts, then, is_joint);
      fmt::print("; with {}{}: {}", proposal, is_joint ? "" : " by itself", fmt::join(verdicts, ", "));
      count("with the proposed one", verdicts, wrong_names(then, drawn.names));
    } else {
      count("with the proposed one", verdicts, wrong_names(first, drawn.names));
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    fmt::print("; {:.0f} s\n", seconds.count());
  }

  void print() const { verdicts_.print(); }

 private:
  void count(const std::string& recordings, const Verdicts& verdicts, const std::vector<std::string>& wrong) {
    verdicts_.count(recordings, "draws");
    if (!wrong.empty()) {
      verdicts_.count(recordings, "with a wrong name");
      fmt::print(" WRONG {}", fmt::join(wrong, ", "));
    }
    if (are_all(verdicts, {"alone", "heads its class"})) verdicts_.count(recordings, "all named");
    if (are_all(verdicts, {"alone"})) verdicts_.count(recordings, "all named alone");
    for (const auto& [name, verdict] : verdicts) verdicts_.count(recordings + ", causes", verdict);
  }

  double size_ = 0.008;  // m
  test::VerdictTable verdicts_;
};

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  return crisp::test::run_trial<crisp::Trial>(argc, argv, "second_recording_trial FIRST DRAWS [MILLIMETRES]");
}
