// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/sick_dialogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::live;
using namespace crisp::wire;

using Effect = SickDialogue::Effect;

Effect send(SickDialogue& dialogue, const std::string& answer) {
  return dialogue.take(*parse_cola(as_bytes(answer), ColaLanguage::A));
}

TEST(SickDialogue, LogsInStartsAndSubscribes) {
  SickDialogue dialogue(ColaLanguage::A, true);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sRN SCdevicestate\x03");
  EXPECT_EQ(send(dialogue, "sRA SCdevicestate 0"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sMN SetAccessMode 3 F4724744\x03");
  EXPECT_EQ(send(dialogue, "sAN SetAccessMode 1"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sMN LMCstartmeas\x03");
  EXPECT_EQ(send(dialogue, "sAN LMCstartmeas 0"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sMN Run\x03");
  EXPECT_EQ(send(dialogue, "sAN Run 1"), Effect::Next);
  EXPECT_EQ(send(dialogue, "sRA SCdevicestate 0"), Effect::RequestLater) << "the motor is not at speed";
  EXPECT_EQ(as_text(dialogue.request()), "\x02sRN SCdevicestate\x03");
  EXPECT_EQ(send(dialogue, "sRA SCdevicestate 1"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sEN LMDscandata 1\x03");
  EXPECT_EQ(send(dialogue, "sEA LMDscandata 1"), Effect::Next);
  EXPECT_EQ(dialogue.step(), SickStep::Scans);
  EXPECT_THAT(dialogue.refusals(), testing::IsEmpty());
}

TEST(SickDialogue, ChangesNothingWhereItMayNotStart) {
  SickDialogue dialogue(ColaLanguage::A, false);
  send(dialogue, "sRA SCdevicestate 1");
  EXPECT_EQ(send(dialogue, "sRA SCdevicestate 1"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sEN LMDscandata 1\x03");
}

TEST(SickDialogue, TakesNothingForAnAnswerThatIsNone) {
  SickDialogue dialogue(ColaLanguage::A, true);
  send(dialogue, "sRA SCdevicestate 1");
  EXPECT_EQ(send(dialogue, "sSN LMDscandata 1 1"), Effect::None);
  EXPECT_EQ(send(dialogue, "sRA SetAccessMode 1"), Effect::None);
  EXPECT_EQ(send(dialogue, "sAN SetAccessModeX 1"), Effect::None);
  EXPECT_EQ(dialogue.step(), SickStep::LogIn);
}

TEST(SickDialogue, GoesOnAfterARefusalAndReportsWhatItWas) {
  SickDialogue dialogue(ColaLanguage::A, true);
  EXPECT_EQ(send(dialogue, "sFA 3"), Effect::Next) << "any answer shows that it understood the language";
  EXPECT_EQ(send(dialogue, "sAN SetAccessMode 0"), Effect::Next);
  EXPECT_EQ(send(dialogue, "sFA 1"), Effect::Next);
  EXPECT_THAT(dialogue.refusals(),
              testing::ElementsAre(
                  "sMN SetAccessMode: answered 0",
                  "sMN LMCstartmeas: sFA 1 (access to the method denied at this user level: log in first)"));
  EXPECT_EQ(dialogue.step(), SickStep::Run);
}

TEST(SickDialogue, GivesUpWhereScansAreRefused) {
  SickDialogue dialogue(ColaLanguage::A, false);
  send(dialogue, "sRA SCdevicestate 1");
  send(dialogue, "sRA SCdevicestate 1");
  EXPECT_EQ(send(dialogue, "sFA F"), Effect::Next);
  EXPECT_EQ(dialogue.step(), SickStep::Refused);
  EXPECT_THAT(dialogue.request(), testing::IsEmpty());
}

TEST(SickDialogue, ConfiguresOnlyWhatIsRequested) {
  SickDialogue dialogue(ColaLanguage::A, true, {.frequency = 25, .remission = true, .ntp_off = true});
  send(dialogue, "sRA SCdevicestate 1");
  send(dialogue, "sAN SetAccessMode 1");
  EXPECT_EQ(as_text(dialogue.request()), "\x02sRN LMPscancfg\x03");
  send(dialogue, "sRA LMPscancfg 1388 1 1388 FFF92230 225510");
  EXPECT_EQ(as_text(dialogue.request()), "\x02sMN mLMPsetscancfg 9C4 1 1388 FFF92230 225510\x03")
      << "the resolution stays";
  EXPECT_TRUE(dialogue.is_slow());
  EXPECT_EQ(send(dialogue, "sMA mLMPsetscancfg"), Effect::None) << "the answer is still to come";
  EXPECT_EQ(send(dialogue, "sAN mLMPsetscancfg 0 9C4 1 1388 FFF92230 225510"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sWN LMDscandatacfg 1 0 1 1 0 0 0 0 0 0 0 1\x03");
  EXPECT_EQ(send(dialogue, "sWA LMDscandatacfg"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sWN TSCRole 0\x03");
  EXPECT_EQ(send(dialogue, "sWA TSCRole"), Effect::Next);
  EXPECT_EQ(dialogue.step(), SickStep::StartMeasuring);
  EXPECT_THAT(dialogue.refusals(), testing::IsEmpty());
}

TEST(SickDialogue, DoesNotTurnTheMotorAnewForWhatItDoesAlready) {
  SickDialogue dialogue(ColaLanguage::A, true,
                        {.frequency = 50, .output_range = {-20 * kDegree, 200 * kDegree}});
  send(dialogue, "sRA SCdevicestate 1");
  send(dialogue, "sAN SetAccessMode 1");
  send(dialogue, "sRA LMPscancfg 1388 1 9C4 FFF92230 225510");
  EXPECT_EQ(as_text(dialogue.request()), "\x02sWN LMPoutputRange 1 9C4 FFFCF2C0 1E8480\x03")
      << "at the resolution that the laser has";
}

TEST(SickDialogue, ReportsWhyASettingIsRefusedAndGoesOn) {
  SickDialogue dialogue(ColaLanguage::A, true,
                        {.resolution = 0.25 * kDegree, .output_range = {-20 * kDegree, 200 * kDegree}});
  send(dialogue, "sRA SCdevicestate 1");
  send(dialogue, "sAN SetAccessMode 1");
  send(dialogue, "sRA LMPscancfg 1388 1 1388 FFF92230 225510");
  EXPECT_EQ(send(dialogue, "sAN mLMPsetscancfg 2 1388 1 1388 FFF92230 225510"), Effect::Next);
  EXPECT_EQ(send(dialogue, "sFA 4"), Effect::Next);
  EXPECT_THAT(dialogue.refusals(),
              testing::ElementsAre("sMN mLMPsetscancfg: answered 2 (the resolution is not possible)",
                                   testing::StartsWith("sWN LMPoutputRange: sFA 4 (")));
  EXPECT_EQ(dialogue.step(), SickStep::StartMeasuring);
}

TEST(SickConfiguration, IsComparedWithWhatTheScansAre) {
  Scan scan{.scan_frequency = 50, .start_angle = -45 * kDegree, .angle_step = 0.5 * kDegree};
  scan.echoes = {{.ranges = std::vector<float>(541, 1.0F)}};
  EXPECT_EQ(difference({.frequency = 50, .resolution = 0.5 * kDegree, .remission = false}, scan), "");
  EXPECT_EQ(difference({.output_range = {-45 * kDegree, 225 * kDegree}}, scan), "");
  EXPECT_EQ(difference({.frequency = 25, .resolution = 0.25 * kDegree, .remission = true}, scan),
            "50 Hz instead of 25 Hz, 0.5 deg from beam to beam instead of 0.25 deg, no remissions");
  EXPECT_EQ(difference({.output_range = {0, 225 * kDegree}}, scan), "beams from -45 to 225 deg");
}

TEST(SickConfiguration, RefusesARangeThatIsNone) {
  EXPECT_NO_THROW(check(SickConfiguration{.output_range = {-0.5, 1}}));
  for (const std::vector<double>& range : {std::vector<double>{1.0}, {1.0, -0.5}, {0, 7}}) {
    EXPECT_THROW(check(SickConfiguration{.output_range = range}), Error);
  }
}

}  // namespace
}  // namespace crisp
