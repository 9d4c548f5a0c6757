// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/recording_proposals.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "pipeline/estimate/free_parameters.hpp"
#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::simulate;
using testing::ElementsAre;
using testing::HasSubstr;

RecordingProposal proposal(const std::string& recording, double detectable, double resolvable) {
  return {.recording = recording,
          .effects = {{.cause = "laser1.mirror.cone", .detectable = detectable, .resolvable = resolvable}}};
}

TEST(RecordingProposals, OfWhichEnoughAreListedTheSurestFirst) {
  const std::vector<RecordingProposal> all = {
      proposal("slow", 0.001, 0.004), proposal("tilted", 0.001, 0.002), proposal("fast", 0.001, 0.008)};
  EXPECT_THAT(resolving(all, "laser1.mirror.cone", 0.005),
              ElementsAre(HasSubstr("tilted (predicted: from 2 mm on; here it is 5 mm)"), HasSubstr("slow")));
  EXPECT_THAT(resolving(all, "laser1.mirror.cone", 0.001), ElementsAre(HasSubstr("tilted")))
      << "the best one";
  EXPECT_THAT(resolving(all, "laser2.mirror.cone", 1), testing::IsEmpty());
  EXPECT_THAT(showing(all, "laser1.mirror.cone", 0.01), HasSubstr("predicted: detectable from 1 mm on"));
  EXPECT_EQ(showing(all, "laser1.mirror.cone", 0.0015), "") << "hardly less";
  EXPECT_EQ(showing(all, "laser2.mirror.cone", 1), "");
}

/// [m] From which size on the proposal that mentions this shows and resolves a cause.
EffectResolution resolution_by(const std::vector<RecordingProposal>& all, const std::string& mention,
                               const std::string& cause) {
  for (const RecordingProposal& one : all) {
    if (one.recording.find(mention) == std::string::npos) continue;
    for (const EffectResolution& effect : one.effects) {
      if (effect.cause == cause) return effect;
    }
  }
  return {};
}

class ProposedRecordings : public testing::Test {
 protected:
  std::vector<RecordingProposal> proposals(const Calibration& calibration) {
    const SensorModel model(calibration, built_in_terms());
    const SurfaceObservations observations(model, covered(recording_.sample(), -0.05, 0.05), {},
                                           settings_.beams);
    return propose_recordings(model, free_parameters(model, recording_.made.beams, {}).free, observations,
                              built_in_terms(), settings_);
  }

  const test::Recording recording_ = test::hidden(6, 4, office(), {});
  DiagnosisSettings settings_;
};

TEST_F(ProposedRecordings, ShowWhatTheRecordingDoesNot) {
  const auto all = proposals(recording_.made.truth);
  ASSERT_EQ(all.size(), 5U);
  // The plate turned one way only.
  EXPECT_TRUE(std::isfinite(resolution_by(all, "to and fro", "encoder.backlash").detectable));
  EXPECT_FALSE(std::isfinite(resolution_by(all, "twice", "encoder.backlash").detectable));
  // Upright walls show a tilt of the scan plane as a cone, inclined ones do not.
  EXPECT_FALSE(std::isfinite(resolution_by(all, "twice", "laser2.mount.scan_plane_tilt").resolvable));
  EXPECT_LT(resolution_by(all, "tilted", "laser2.mount.scan_plane_tilt").resolvable, 0.005);
}

TEST_F(ProposedRecordings, CountByThemselvesWhereTheModelHasAnEffectOfTime) {
  settings_.beams = 10'000'000;     // no limit to those of both
  settings_.selection.visible = 0;  // nor of the effects that count
  Calibration drifting = recording_.made.truth;
  const auto drift = built_in_terms().get("range.warmup");
  drifting.lasers[2].terms.push_back(neutral_parameters(drift->info()));
  const auto together = proposals(recording_.made.truth);
  const auto alone = proposals(drifting);
  for (const char* const cause : {"laser1.mirror.cone", "laser2.range.scale", "laser1.mirror.eccentricity"}) {
    const double of_both = resolution_by(together, "twice", cause).detectable;
    const double of_one = resolution_by(alone, "twice", cause).detectable;
    EXPECT_NEAR(of_one / of_both, std::sqrt(2), 0.1) << cause << ": twice the beams";
  }
}

}  // namespace
}  // namespace crisp
