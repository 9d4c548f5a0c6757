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

using namespace crisp::files;

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

/// What the diagnosis of a capture accepted, and what was hidden.
struct Diagnosed {
  std::vector<Finding> accepted;
  std::string cause;
  std::string console;
};

Diagnosed diagnosed(std::uint64_t seed, Names draws, const Names& overrides) {
  const test::PipelineFixture fixture;
  draws.insert(draws.end(), {"fault=none", "has_mixed_pixels=0", "duration=10"});
  const test::DrawnRig drawn(fixture / "drawn", seed, draws);
  const auto outcome = fixture.run("diagnose.yaml", drawn.capture(), "out", overrides, drawn.rig());
  Diagnosed result{.accepted = {}, .cause = drawn.effect().cause, .console = outcome.console};
  if (std::ranges::count(outcome.files, "diagnosis.json") == 0) return result;
  for (const Finding& finding : read_findings(fixture / "out/diagnosis.json").findings) {
    if (finding.accepted) result.accepted.push_back(finding);
  }
  return result;
}

/// Diagnoses a capture, and checks that what has a name has that of its cause.
void is_named(std::uint64_t seed, const Names& draws, const Names& overrides) {
  const Diagnosed result = diagnosed(seed, draws, overrides);
  EXPECT_FALSE(result.accepted.empty()) << result.cause << "\n" << result.console;
  for (const Finding& finding : result.accepted) {
    EXPECT_THAT(class_of(finding), testing::Contains(result.cause))
        << finding.scope << "." << finding.cause << "\n"
        << result.console;
  }
}

TEST_P(Forms, HaveTheNameOfTheirCause) {
  Names draws = GetParam().draws;
  draws.insert(draws.end(), {"kind=lms1xx", "lasers=3", "orientation=tangential", "motion=varied"});
  is_named(GetParam().seed, draws, {"diagnose.model.refine_beams=0"});
}

// With more beams the general member of base.motion gains more than its formulas, and takes their place.
TEST(FormsWithAllBeams, AGeneralMemberMayReplaceItsFormula) { is_named(3005, {"effect=settles"}, {}); }

// A curve of remission has coefficients where there are few beams; they ran off to their bounds, and spoilt
// the held-out turns.
TEST(FormsWithAllBeams, ACurveWithFewBeamsAtItsEndIsNamed) { is_named(6180, {"has_effect=1"}, {}); }

// Surfaces that the plain model selects are those where a large error hardly shows.
TEST(FormsWithAllBeams, ALargeErrorOfAllRangesIsNamed) { is_named(6133, {"has_effect=1"}, {}); }

// Two formulas, a general member and a formula replace one another before the general member stays.
TEST(FormsWithAllBeams, ACandidateThatWasReplacedComesBack) { is_named(6182, {"has_effect=1"}, {}); }

// A curve over incidence explains all, and two formulas that do not took its place.
TEST(FormsWithAllBeams, TheSearchReturnsToAModelThatExplainsAll) {
  const Diagnosed result = diagnosed(6189, {"has_effect=1"}, {});
  ASSERT_EQ(result.accepted.size(), 1U) << result.console;
  EXPECT_EQ(result.accepted[0].cause, "range.incidence") << result.console;
}

INSTANTIATE_TEST_SUITE_P(
    Of, Forms,
    testing::Values(Form{6, {"effect=third_harmonic", "effect_amount=3", "scene=office"}},
                    Form{7, {"effect=two_tones", "effect_rms=6", "scene=office", "effect_laser=0"}},
                    Form{8, {"effect=settles", "effect_rms=8", "scene=office"}}));

}  // namespace
}  // namespace crisp
