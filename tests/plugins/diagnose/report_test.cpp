// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kNoise = 0.012;  // [m]

/// What a look at no candidate at all finds: nothing is taken into the model.
Diagnosis without_candidates(const test::Recording& recording) {
  DiagnosisSettings settings;
  settings.rounds = 0;
  return test::diagnosed(recording, settings);
}

Findings reported(const Diagnosis& diagnosis) {
  return findings_of(diagnosis, diagnosis.after.outcome.model.calibration(), built_in_terms(), {}, kNoise);
}

test::Recording with_a_third_harmonic() {
  test::Recording recording = test::hidden(4, 3, office(), {});
  Measurements& beams = recording.made.beams;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] == 2) beams.range[i] += 0.006F * std::sin(3 * beams.mirror_angle[i]);
  }
  return recording;
}

std::vector<UnnamedFinding> over_the_mirror(const Findings& findings) {
  std::vector<UnnamedFinding> found;
  for (const UnnamedFinding& finding : findings.unnamed) {
    if (finding.covariate == "mirror angle" && finding.scope == "laser3") found.push_back(finding);
  }
  return found;
}

TEST(Report, HasWhatTheModelLeavesAmongTheUnnamed) {
  Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  const Findings findings = reported(diagnosis);
  const auto found = over_the_mirror(findings);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].quantity, "range");
  EXPECT_EQ(found[0].unit, "m");
  EXPECT_NEAR(found[0].amplitude, 0.006 / std::sqrt(2), 0.0025) << "less what planes take of it";
  EXPECT_LE(found[0].p_value, 0.01);
  EXPECT_FALSE(found[0].accepted) << "no term was taken";
  EXPECT_THAT(in_words(found[0]), HasSubstr("no term of the catalogue takes it"));
}

TEST(Report, SaysOnceWhatATermWasRefusedFor) {
  Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  diagnosis.departures.push_back({.candidate = {.owner = 2,
                                                .term = {.term = "empirical.range_by_mirror_angle"},
                                                .name = "laser3.empirical.range_by_mirror_angle",
                                                .covariate = "mirror angle"},
                                  .look = {},
                                  .rivals = {},
                                  .gains = {},
                                  .accepted = false});
  EXPECT_THAT(over_the_mirror(reported(diagnosis)), SizeIs(1));
}

TEST(Report, HasNothingUnnamedThatChanceOrAWallsBumpsMayHaveMade) {
  const Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  Diagnosis chance = diagnosis;
  for (Profile& profile : chance.left_after.profiles) profile.p_value = 0.015;
  EXPECT_THAT(reported(chance).unnamed, IsEmpty());
  Diagnosis bumps = diagnosis;
  for (Profile& profile : bumps.left_after.profiles) profile.rms = 0.9 * SelectionSettings{}.visible * kNoise;
  EXPECT_THAT(reported(bumps).unnamed, IsEmpty());
}

}  // namespace
}  // namespace crisp
