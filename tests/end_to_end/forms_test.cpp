// SPDX-License-Identifier: BSD-3-Clause
// Effects whose form is not the catalogue's, as another simulator makes them (tests/independent): each has
// the name of its cause, or a class that holds it, and nothing else has a name.
#include <gmock/gmock.h>

#include <algorithm>

#include "pipeline/files/findings_file.hpp"
#include "tests/end_to_end/drawn_rig.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"

namespace crisp {
namespace {

using Names = std::vector<std::string>;

/// An effect, with the draws that are fixed.
struct Form {
  std::uint64_t seed;
  Names draws;
};

void PrintTo(const Form& form, std::ostream* out) { *out << form.draws.front() << ", seed " << form.seed; }

class Forms : public testing::TestWithParam<Form> {};

/// Names that the finding stands for.
Names class_of(const Finding& finding) {
  Names names = {finding.cause};
  for (const std::string& other : finding.confounded_with) {
    const bool is_of_laser = other.starts_with(finding.scope + ".");
    names.push_back(is_of_laser ? other.substr(finding.scope.size() + 1) : other);
  }
  return names;
}

TEST_P(Forms, HaveTheNameOfTheirCause) {
  const test::PipelineFixture fixture;
  Names draws = GetParam().draws;
  draws.insert(draws.end(), {"fault=none", "has_mixed_pixels=0", "duration=10", "kind=lms1xx", "lasers=3",
                             "orientation=tangential", "motion=varied"});
  const test::DrawnRig drawn(fixture / "drawn", GetParam().seed, draws);
  const auto outcome =
      fixture.run("diagnose.yaml", drawn.capture(), "out", {"diagnose.model.refine_beams=0"}, drawn.rig());
  ASSERT_EQ(std::ranges::count(outcome.files, "diagnosis.json"), 1) << outcome.console;
  bool is_named = false;
  for (const Finding& finding : read_findings(fixture / "out/diagnosis.json").findings) {
    if (!finding.accepted) continue;
    const bool is_right = std::ranges::count(class_of(finding), drawn.effect().cause) > 0;
    EXPECT_TRUE(is_right) << finding.scope << "." << finding.cause << "\n" << outcome.console;
    is_named = is_named || is_right;
  }
  EXPECT_TRUE(is_named) << drawn.effect().cause << "\n" << outcome.console;
}

INSTANTIATE_TEST_SUITE_P(
    Of, Forms,
    testing::Values(Form{6, {"effect=third_harmonic", "effect_amount=3", "scene=office"}},
                    Form{7, {"effect=two_tones", "effect_rms=6", "scene=office", "effect_laser=0"}},
                    Form{8, {"effect=settles", "effect_rms=8", "scene=office"}}));

}  // namespace
}  // namespace crisp
