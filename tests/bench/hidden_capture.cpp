// SPDX-License-Identifier: BSD-3-Clause
// Rate at which the whole pipeline names an injected effect of a capture: clocks, links, noise of ranges,
// moving things, and terms of the sensor model, which hidden_trial injects into measurements. Each capture is
// simulated from a seed, and configs/diagnose.yaml gets nothing else. Prints a line for each capture, and a
// table in the end.
//
//     hidden_capture [SEEDS [FIRST [EFFECT]]]       EFFECT: one of them, `none`, or `terms`: all of the model
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <span>

#include "pipeline/files/findings_file.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/plugins/diagnose/noise/drawn.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::diagnose;
using namespace crisp::files;
using namespace crisp::simulate;

using Scenes = std::vector<std::string>;

/// An injected effect: its own parameters and the other settings it needs.
struct Hidden {
  std::string cause;
  std::string scope;                    ///< whose it is
  std::map<std::string, double> truth;  ///< in SI
  std::string given;                    ///< further effects in YAML
  std::string makes;                    ///< cause that is there with it
  Scenes scenes = {"office", "hall", "street"};
  double duration = 10;                ///< [s]
  std::vector<std::string> simulated;  ///< further options of grabber.simulate
  std::vector<std::string> requested;  ///< further settings of the diagnosis
};

class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : random_(seed) {}

  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  double signed_between(double from, double to) { return (below(2) == 0 ? 1 : -1) * uniform(from, to); }
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  std::string laser() { return "laser" + std::to_string(1 + below(3)); }
  std::string device() { return below(4) == 0 ? "plate" : laser(); }

 private:
  std::mt19937_64 random_;
};

/// How each is drawn; sizes are those of real devices (docs/effects.md).
using Draw = std::function<Hidden(Drawer&)>;
const std::map<std::string, Draw>& draws() {
  static const std::map<std::string, Draw> all = {
      {"none", [](Drawer&) { return Hidden{}; }},
      {"clock.drift",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(),
                       .truth = {{"drift", d.signed_between(0.3e-6, 3e-6)}},
                       .scenes = {"office"},
                       .duration = 60};
       }},
      {"clock.step",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(),
                       .truth = {{"by", d.signed_between(0.5e-3, 50e-3)}, {"at", d.uniform(1.5, 8.5)}}};
       }},
      {"latency.step",
       [](Drawer& d) {
         const bool shorter = d.below(2) == 0;  // by less than the millisecond that a laser's link has
         const double by = shorter ? -d.uniform(0.4e-3, 0.9e-3) : d.uniform(0.5e-3, 5e-3);
         return Hidden{.scope = shorter ? d.laser() : d.device(),
                       .truth = {{"by", by}, {"at", d.uniform(1.5, 8.5)}}};
       }},
      {"noise.heavy_tail",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(),
                       .truth = {{"share", d.uniform(0.015, 0.05)}, {"scale", d.uniform(4, 7)}}};
       }},
      {"noise.range_dependent",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(),
                       .truth = {{"slope", d.uniform(0.0015, 0.004)}},
                       .scenes = {"hall", "street"}};
       }},
      {"noise.incidence_dependent",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(), .truth = {{"spread", d.uniform(0.006, 0.012)}}};
       }},
      {"noise.remission_dependent",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(), .truth = {{"jitter", d.uniform(0.06, 0.12)}}};
       }},
      {"noise.two_peaks",
       [](Drawer& d) {
         const std::string laser = d.laser();
         return Hidden{.scope = laser,
                       .truth = {{"separation", d.uniform(0.0135, 0.0167)},
                                 {"least", d.uniform(0.05, 0.35)},
                                 {"most", d.uniform(0.65, 0.95)}},
                       .given = fmt::format(", {}.noise.normal: {{sigma: {}}}", laser, d.uniform(4e-3, 6e-3)),
                       .makes = "range.offset"};  // the farther peak is the higher one
       }},
      {"noise.quantisation",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(), .truth = {{"step", 1e-3 * (4 + d.below(12))}}};
       }},
      {"noise.mixed_pixels",
       [](Drawer& d) {
         return Hidden{.scope = d.laser(),
                       .truth = {{"divergence", d.uniform(0.012, 0.016)}, {"aperture", 0.008}},
                       .scenes = {"office", "workshop"}};
       }},
      {"scene.moving", [](Drawer&) { return Hidden{.scope = "scene", .scenes = {"people"}}; }},
  };
  return all;
}

/// A term of the model, by which ranges change by 8 mm RMS; nothing if its bounds do not let it.
std::optional<Hidden> hidden_term(const std::string& term, std::uint64_t seed) {
  constexpr double kSize = 0.008;  // [m]
  const test::Drawn drawn = test::Drawer(seed, default_rig()).with({term}, kSize);
  if (!drawn.reaches(kSize)) return std::nullopt;
  const Calibration& truth = drawn.recording.scanner.truth;
  Hidden hidden{.scope = "plate", .scenes = {drawn.scene}};
  const TermParameters* found = find_term(truth.plate_terms, term);
  for (const LaserCalibration& laser : truth.lasers) {
    if (found) break;
    found = find_term(laser.terms, term);
    hidden.scope = laser.name;
  }
  for (const Parameter& parameter : found->parameters) hidden.truth[parameter.name] = parameter.value;
  const MotionSettings& motion = drawn.recording.scanner.motion;
  hidden.simulated = {motion.kind == MotionKind::reversal ? "motion.kind=reversal" : "motion.kind=varying",
                      fmt::format("motion.min_rate={}Hz", motion.min_rate),
                      fmt::format("motion.max_rate={}Hz", motion.max_rate)};
  if (term == "mirror.period") {  // clock stages measure it; that it should be nominal must be requested
    hidden.simulated.emplace_back("lasers.mirror_slowest=0");
    hidden.requested.emplace_back("diagnose.clocks.nominal_mirrors=true");
  }
  return hidden;
}

std::vector<std::string> terms() {
  std::vector<std::string> names = test::causes();
  std::erase_if(names, [](const std::string& name) { return draws().contains(name); });
  return names;
}

std::string effects_of(const Hidden& hidden) {
  if (hidden.truth.empty()) return "effects={}";
  std::string parameters;
  for (const auto& [name, value] : hidden.truth) {
    parameters += fmt::format("{}{}: {}", parameters.empty() ? "" : ", ", name, value);
  }
  const std::string owner =
      hidden.scope == "plate" && built_in_terms().knows(hidden.cause) ? "" : hidden.scope + ".";
  return fmt::format("effects={{{}{}: {{{}}}{}}}", owner, hidden.cause, parameters, hidden.given);
}

/// Its name in the lists of indistinguishable and unobservable causes.
std::string full_name(const Hidden& hidden) {
  return (hidden.scope == "plate" ? "" : hidden.scope + ".") + hidden.cause;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

struct Row {
  int captures = 0, named = 0, in_class = 0, unobservable = 0, wrong = 0, parameters = 0, within_three = 0;
};

class Trial {
 public:
  void run(const std::string& cause, std::uint64_t seed) {
    Drawer drawer(seed);
    std::optional<Hidden> drawn =
        draws().contains(cause) ? draws().at(cause)(drawer) : hidden_term(cause, seed);
    if (!drawn) {
      fmt::print("{:<22} seed {:<4} cannot be so large within its bounds\n", cause, seed);
      return;
    }
    Hidden& hidden = *drawn;
    hidden.cause = cause;
    const std::string scene = hidden.scenes[drawer.below(hidden.scenes.size())];
    const test::PipelineFixture fixture;
    std::vector<std::string> options = hidden.simulated;
    options.insert(options.end(), {fmt::format("seed={}", seed), "scene=" + scene,
                                   fmt::format("duration={}s", hidden.duration), effects_of(hidden)});
    fixture.simulate("made", options);
    const auto outcome = fixture.run("diagnose.yaml", fixture / "made/hub.pcap", "out", hidden.requested);
    if (!std::ranges::count(outcome.files, "diagnosis.json")) throw Error(cause + ": " + outcome.console);
    fmt::print("{:<22} seed {:<4} {:<8} {}; found:", cause, seed, scene, effects_of(hidden));
    count(hidden, read_findings(fixture / "out/diagnosis.json"));
    fmt::print("{}\n", outcome.status == ExitStatus::done ? "" : "; the calibration is with_caveats");
    std::fflush(stdout);
  }

  void print() const {
    fmt::print(
        "\n| injected | captures | named | its class | reported as unobservable | wrong names | parameters within 3 s.e. |\n|---|---|---|---|---|---|---|\n");
    for (const auto& [cause, row] : rows_) {
      fmt::print("| {} | {} | {} | {} | {} | {} | {} of {} |\n", cause, row.captures, row.named, row.in_class,
                 row.unobservable, row.wrong, row.within_three, row.parameters);
    }
  }

 private:
  void count(const Hidden& hidden, const Findings& findings) {
    Row& row = rows_[hidden.cause];
    ++row.captures;
    bool named = false;
    bool in_class = false;
    for (const Finding& finding : findings.findings) {
      fmt::print(" {}.{}{}", finding.scope, finding.cause, finding.accepted ? "" : "(refused)");
      if (!finding.accepted) continue;
      const bool right =
          finding.cause == hidden.cause && (finding.scope == hidden.scope || hidden.cause == "scene.moving");
      const bool stands_for_it = contains(finding.confounded_with, full_name(hidden));
      in_class = in_class || stands_for_it;
      row.wrong += right || stands_for_it || is_made(hidden, finding) ? 0 : 1;
      if (right && !named) count_parameters(hidden, finding, row);
      named = named || right;
    }
    for (const auto& unnamed : findings.unnamed) fmt::print(" unnamed over {}", unnamed.covariate);
    const bool unobservable = std::ranges::any_of(
        findings.unobservable, [&](const Unobservable& one) { return one.parameter == full_name(hidden); });
    if (unobservable) fmt::print(" reported as unobservable");
    row.named += named ? 1 : 0;
    row.in_class += !named && in_class ? 1 : 0;
    row.unobservable += !named && !in_class && unobservable ? 1 : 0;
  }

  /// Whether the injected effect produces the finding as well, or is indistinguishable from it.
  static bool is_made(const Hidden& hidden, const Finding& finding) {
    const std::string full = hidden.scope + "." + hidden.makes;
    return !hidden.makes.empty() &&
           (finding.scope + "." + finding.cause == full || contains(finding.confounded_with, full));
  }

  static void count_parameters(const Hidden& hidden, const Finding& finding, Row& row) {
    for (const Parameter& reported : finding.parameters) {
      const auto truth = hidden.truth.find(reported.name);
      if (truth == hidden.truth.end() || !(reported.std_error > 0)) continue;
      const double error = (reported.value - truth->second) / reported.std_error;
      fmt::print(" {} {:+.1f} s.e.", reported.name, error);
      ++row.parameters;
      row.within_three += std::abs(error) < 3 ? 1 : 0;
    }
  }

  std::map<std::string, Row> rows_;
};

void run(std::uint64_t seeds, std::uint64_t first, const std::string& effect) {
  Trial trial;
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    std::uint64_t k = 0;
    for (const auto& [cause, draw] : draws()) {
      const std::uint64_t own = seed + 1000 * ++k;
      if (effect.empty() ? cause != "none" : cause == effect) trial.run(cause, own);
    }
    for (const auto& cause : terms()) {
      const std::uint64_t own = seed + 1000 * ++k;
      if (effect == "terms" || effect == cause) trial.run(cause, own);
    }
  }
  trial.print();
}

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  const auto number = [&](std::size_t at, std::uint64_t otherwise) {
    return arguments.size() > at ? std::strtoull(arguments[at], nullptr, 10) : otherwise;
  };
  try {
    crisp::run(number(1, 10), number(2, 1), arguments.size() > 3 ? arguments[3] : "");
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
