// SPDX-License-Identifier: BSD-3-Clause
// Whether study.detection predicts which effects the diagnosis finds: tests/independent simulates captures
// with an effect of half the size that is predicted to be detectable, and of twice the size that is predicted
// to be resolvable (or detectable, where its cause is predicted to stay confounded). Prints a line for each
// capture, and counts in the end.
//
//     detection_trial FIRST DRAWS FORM [NAME=VALUE...]      FORM of tests/independent: off_axis,
//     tilted_plane, bent_cone
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/files/findings_file.hpp"
#include "tests/bench/trial.hpp"
#include "tests/end_to_end/drawn_rig.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::files;

/// The sizes [m] that are predicted for an effect, if they are finite.
struct Predicted {
  std::optional<double> detectable;
  std::optional<double> resolvable;
};

Predicted predicted(const test::PipelineFixture& fixture, const test::DrawnRig& drawn) {
  std::vector<std::string> set;
  for (const auto& option : drawn.plan()) set.push_back("study.detection." + option);
  const auto outcome = fixture.run("detection.yaml", {}, "detection", set, drawn.rig());
  const auto effects = outcome.stage("study.detection").at("report").at("effects");
  Predicted most;  // of all lasers that have the effect
  for (const auto& [name, effect] : effects.items()) {
    if (!name.ends_with(drawn.effect().cause)) continue;
    const bool is_other = drawn.effect().scope != "all" && name != drawn.effect().cause &&
                          !name.starts_with(drawn.effect().scope + ".");
    if (is_other) continue;
    const auto add = [](std::optional<double>& size, double one) { size = std::max(size.value_or(0), one); };
    if (effect.contains("detectable")) add(most.detectable, effect["detectable"]);
    if (effect.contains("resolvable")) add(most.resolvable, effect["resolvable"]);
  }
  return most;
}

class DetectionTrial {
 public:
  explicit DetectionTrial(std::vector<std::string> rest)
      : form_(rest.front()), fixed_(rest.begin() + 1, rest.end()) {}

  void run(std::uint64_t seed) {
    const test::PipelineFixture fixture;
    const Predicted sizes = predicted(fixture, drawn(fixture, seed, 0.01));
    if (!sizes.detectable) {
      fmt::print("{} predicted: never detectable\n", seed);
      verdicts_.count("predicted never", "drawn");
      return;
    }
    judge(fixture, seed, 0.5 * *sizes.detectable, "half of detectable");
    judge(fixture, seed, 2 * sizes.resolvable.value_or(*sizes.detectable),
          sizes.resolvable ? "twice resolvable" : "twice detectable");
  }

  void print() const { verdicts_.print(); }

 private:
  test::DrawnRig drawn(const test::PipelineFixture& fixture, std::uint64_t seed, double size) const {
    std::vector<std::string> draws = {"fault=none", "has_mixed_pixels=0", "duration=10", "effect=" + form_,
                                      fmt::format("effect_rms={}", 1e3 * size)};
    draws.insert(draws.end(), fixed_.begin(), fixed_.end());
    return {fixture / fmt::format("drawn{}", size), seed, draws};
  }

  void judge(const test::PipelineFixture& fixture, std::uint64_t seed, double size, const std::string& what) {
    const test::DrawnRig rig = drawn(fixture, seed, size);
    const auto outcome = fixture.run("diagnose.yaml", rig.capture(), "out", {}, rig.rig());
    std::string verdict = "refused";
    std::vector<std::string> all;
    if (std::ranges::count(outcome.files, "diagnosis.json") > 0) {
      verdict = "nothing";
      for (const Finding& finding : read_findings(fixture / "out/diagnosis.json").findings) {
        if (!finding.accepted) continue;
        all.push_back(fmt::format("{}.{}", finding.scope, finding.cause));
        const bool is_class = std::ranges::any_of(finding.confounded_with, [&](const std::string& name) {
          return name.ends_with(rig.effect().cause);
        });
        if (finding.cause == rig.effect().cause)
          verdict = finding.confounded_with.empty() ? "name" : "name in a class";
        else if (verdict == "nothing")
          verdict = is_class ? "class" : "other name";
      }
    }
    verdicts_.count(what, verdict);
    fmt::print("{} {} {:.3g} mm, {}: {} ({}); {}\n", seed, form_, 1e3 * size, what, verdict,
               fmt::join(all, " "), rig.words());
  }

  std::string form_;
  std::vector<std::string> fixed_;
  test::VerdictTable verdicts_;  // by size
};

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  return crisp::test::run_trial<crisp::DetectionTrial>(argc, argv,
                                                       "detection_trial FIRST DRAWS FORM [NAME=VALUE...]", 1);
}
