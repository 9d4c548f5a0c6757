// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/cross_validation.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/plugins/diagnose/hidden.hpp"
#include "tests/support/several_recordings.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::simulate;

TEST(CrossValidator, HalvesShareNoTurnAndNoBeamIsLost) {
  const auto recording = test::hidden(1, 6, office(), {});
  const Sample all = recording.sample();
  const Halves halves = halves_of(all);
  EXPECT_EQ(halves.fitted.beams.size() + halves.held_out.beams.size(), all.beams.size());
  EXPECT_GT(halves.fitted.beams.size(), all.beams.size() / 4);
  EXPECT_GT(halves.held_out.beams.size(), all.beams.size() / 4);
  EXPECT_EQ(halves.turn.size(), halves.held_out.beams.size());
  EXPECT_GE(*std::ranges::max_element(halves.turn), 1U);
  ASSERT_EQ(halves.piece.size(), halves.turn.size());
  for (std::size_t i = 0; i < halves.turn.size(); ++i) ASSERT_EQ(halves.piece[i] / 8, halves.turn[i]);
  const std::set<std::uint32_t> pieces(halves.piece.begin(), halves.piece.end());
  const std::set<std::uint32_t> turns(halves.turn.begin(), halves.turn.end());
  EXPECT_GE(pieces.size(), 7 * turns.size()) << "the first and the last turn may be parts of one";
  const Halves others = halves_of(all, 0);
  EXPECT_EQ(others.held_out.beams.time, halves.fitted.beams.time);
  EXPECT_EQ(others.fitted.beams.time, halves.held_out.beams.time);
}

TEST(CrossValidator, HoldsOutEveryOtherOfSeveralRecordings) {
  const auto recording = test::hidden(1, 6, office(), {}).made;
  const test::Several three = test::several({recording, recording, recording});
  const Halves halves = halves_of(three.sample());
  EXPECT_EQ(halves.fitted.beams.size(), 2 * recording.beams.size());
  EXPECT_EQ(halves.held_out.beams.range, recording.beams.range) << "the second recording";
  const std::set<std::uint32_t> turns(halves.turn.begin(), halves.turn.end());
  EXPECT_GE(turns.size(), 4U);
}

TEST(CrossValidator, EstimatesTheGainOfAnInjectedChange) {
  const auto recording = test::hidden(2, 6, office(), {{"laser2.range.offset", {0.01}}});
  const SensorModel truth(recording.scanner.truth, built_in_terms());
  const SensorModel plain(nominal_calibration(default_rig()), built_in_terms());
  const CrossValidator held_out(halves_of(recording.sample()), {plain}, {});
  const auto gains = CrossValidator::gains(held_out.score(plain), held_out.score(truth));
  const auto thickness = std::ranges::find(gains, "cloud thickness", &Gain::metric);
  ASSERT_NE(thickness, gains.end());
  EXPECT_LT(thickness->ci95[1], 0);
  EXPECT_LT(thickness->after, thickness->before);
  const auto likelihood = std::ranges::find(gains, CrossValidator::kLikelihood, &Gain::metric);
  EXPECT_GT(likelihood->ci95[0], 0);
  const auto lasers = std::ranges::find(gains, "disagreement of lasers", &Gain::metric);
  EXPECT_GT(lasers->before, 5 * lasers->after) << "10 mm of one laser against two";
}

/// Surfaces that a model without the term selects are those where its error hardly shows.
TEST(CrossValidator, GivesALargeTrueEffectAGainOnTheSurfacesOfBothModels) {
  std::map<std::string, std::vector<double>> cyclic;
  for (const char* laser : {"laser1", "laser2", "laser3"})
    cyclic[std::string(laser) + ".range.cyclic"] = {0.03, 0, 0.7};
  const auto recording = test::hidden(5, 4, office(), cyclic);
  const SensorModel truth(recording.scanner.truth, built_in_terms());
  Calibration without = recording.scanner.truth;
  for (LaserCalibration& laser : without.lasers) laser.terms.clear();
  const SensorModel plain(without, built_in_terms());
  const auto least_gain = [&](const std::vector<SensorModel>& choosers) {
    const CrossValidator held_out(halves_of(recording.sample()), choosers, {});
    const auto gains = CrossValidator::gains(held_out.score(plain), held_out.score(truth));
    return std::ranges::find(gains, CrossValidator::kLikelihood, &Gain::metric)->ci95[0];
  };
  EXPECT_GT(least_gain({plain, truth}), 0.1);
  EXPECT_GT(least_gain({plain, truth}), least_gain({plain}));
}

/// A range that drifts off in the recording's first second only gains in one turn of several.
TEST(CrossValidator, HasAnIntervalWithoutZeroForAGainInOneTurn) {
  CrossValidator::Score before;
  CrossValidator::Score after;
  for (int piece = 0; piece < 32; ++piece) {
    const double gain = piece < 8 ? 40 + piece % 3 : piece % 2;
    before.pieces.push_back({.weight = 1000, .likelihood = 0});
    after.pieces.push_back({.weight = 1000, .likelihood = gain});
  }
  const auto gains = CrossValidator::gains(before, after);
  const auto likelihood = std::ranges::find(gains, CrossValidator::kLikelihood, &Gain::metric);
  ASSERT_NE(likelihood, gains.end());
  EXPECT_GT(likelihood->ci95[0], 0);
  EXPECT_LT(likelihood->ci95[0], 0.5 * likelihood->after) << "turns differ";
}

TEST(CrossValidator, EstimatesNoGainWithoutAChange) {
  const auto recording = test::hidden(3, 6, office(), {});
  const SensorModel truth(recording.scanner.truth, built_in_terms());
  const CrossValidator held_out(halves_of(recording.sample()), {truth}, {});
  const auto score = held_out.score(truth);
  for (const Gain& gain : CrossValidator::gains(score, score)) {
    EXPECT_EQ(gain.before, gain.after) << gain.metric;
    EXPECT_EQ(gain.ci95[0], 0) << gain.metric;
    EXPECT_EQ(gain.ci95[1], 0) << gain.metric;
  }
}

TEST(CrossValidator, ScoresNoRigidMotion) {
  const auto recording = test::hidden(4, 6, office(), {});
  Calibration turned = recording.scanner.truth;
  for (LaserCalibration& laser : turned.lasers) laser.lambda.value += 0.4;  // of the whole cloud about z
  const SensorModel truth(recording.scanner.truth, built_in_terms());
  const CrossValidator held_out(halves_of(recording.sample()), {truth}, {});
  const auto score = held_out.score(truth);
  for (const Gain& gain : CrossValidator::gains(score, held_out.score(SensorModel(turned, built_in_terms()))))
    EXPECT_NEAR(gain.after, gain.before, 1e-9) << gain.metric;
}

}  // namespace
}  // namespace crisp
