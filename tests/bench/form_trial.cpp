// SPDX-License-Identifier: BSD-3-Clause
// Rate at which the diagnosis names an effect whose form is not the catalogue's: tests/independent simulates
// captures with effects in forms of its own, and configs/diagnose.yaml gets the capture and the rig's file.
// Prints a line for each capture, and counts in the end.
//
//     form_trial FIRST DRAWS [NAME=VALUE...]      as independent_scanner has them: effect=rocks, scene=hall
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/files/findings_file.hpp"
#include "tests/bench/trial.hpp"
#include "tests/end_to_end/drawn_rig.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::files;

using Names = std::vector<std::string>;

class FormTrial {
 public:
  explicit FormTrial(Names fixed) : fixed_(std::move(fixed)) {}

  void run(std::uint64_t seed) {
    const test::PipelineFixture fixture;
    Names draws = {"fault=none", "has_mixed_pixels=0", "duration=10", "has_effect=1"};
    draws.insert(draws.end(), fixed_.begin(), fixed_.end());
    const test::DrawnRig drawn(fixture / "drawn", seed, draws);
    const auto begin = std::chrono::steady_clock::now();
    const auto outcome = fixture.run("diagnose.yaml", drawn.capture(), "out", {}, drawn.rig());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const auto& effect = drawn.effect();
    fmt::print("{:<5} {:<14} {:<20} {:<6} {:4.1f} mm {:3.0f} s; {}", seed, effect.form, effect.cause,
               effect.scope, 1e3 * effect.rms, took.count(), drawn.words());
    if (std::ranges::count(outcome.files, "diagnosis.json") == 0)
      count(effect.cause, "refused");
    else
      judge(effect, read_findings(fixture / "out/diagnosis.json"));
    fmt::print("{}\n", outcome.status == ExitStatus::done ? "" : "; untrusted");
  }

  void print() const { verdicts_.print(); }

 private:
  void count(const std::string& cause, const std::string& verdict) {
    for (const std::string& kind : {cause, std::string("all")}) verdicts_.count(kind, verdict);
    fmt::print("; {}", verdict);
  }

  /// What an effect is that has no name.
  static std::string unidentified(const std::string& cause, const Findings& findings) {
    if (!findings.unnamed.empty()) return "unnamed";
    const bool is_listed = std::ranges::any_of(findings.unobservable, [&](const Unobservable& one) {
      return one.parameter == cause || one.parameter.ends_with("." + cause);
    });
    return is_listed ? "listed as unobservable" : "missed";
  }

  /// All findings, those without a name as well, in words.
  static Names in_words(const Findings& findings) {
    Names all;
    for (const Finding& finding : findings.findings)
      all.push_back(fmt::format(
          "{}.{}{}{}", finding.scope, finding.cause, finding.accepted ? "" : " rejected",
          finding.confounded_with.empty() ? ""
                                          : fmt::format(" [{}]", fmt::join(finding.confounded_with, " "))));
    for (const UnnamedFinding& unnamed : findings.unnamed)
      all.push_back(fmt::format("{}: {} over {} {:.1f} mm", unnamed.scope, unnamed.quantity,
                                unnamed.covariate, 1e3 * unnamed.amplitude));
    return all;
  }

  void judge(const test::InjectedEffect& effect, const Findings& findings) {
    Names right, in_class, wrong;
    for (const Finding& finding : findings.findings) {
      if (!finding.accepted) continue;
      const bool holds = std::ranges::any_of(finding.confounded_with, [&](const std::string& name) {
        return name == effect.cause || name.ends_with("." + effect.cause);
      });
      (finding.cause == effect.cause ? right : holds ? in_class : wrong).push_back(finding.cause);
    }
    const bool is_plain = effect.cause == "none" || effect.cause == "shape";
    const std::string false_name = wrong.empty() ? "" : is_plain ? "false name" : " and a false name";
    if (is_plain)
      count(effect.cause, !false_name.empty()      ? false_name
                          : effect.cause == "none" ? "nothing"
                                                   : unidentified(effect.cause, findings));
    else if (!right.empty() || !in_class.empty())
      count(effect.cause, (right.empty() ? "class" : "right") + false_name);
    else
      count(effect.cause, !wrong.empty() ? "wrong name" : unidentified(effect.cause, findings));
    fmt::print(": {}", fmt::join(in_words(findings), ", "));
  }

  Names fixed_;
  test::VerdictTable verdicts_;  // by cause
};

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  return crisp::test::run_trial<crisp::FormTrial>(argc, argv, "form_trial FIRST DRAWS [NAME=VALUE...]");
}
