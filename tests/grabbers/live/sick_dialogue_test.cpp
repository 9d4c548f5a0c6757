// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/sick_dialogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace crisp {
namespace {

using Effect = SickDialogue::Effect;

Effect say(SickDialogue& dialogue, const std::string& answer) {
  return dialogue.take(*parse_cola(as_bytes(answer), ColaLanguage::A));
}

TEST(SickDialogue, LogsInStartsAndSubscribes) {
  SickDialogue dialogue(ColaLanguage::A, true);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sRN SCdevicestate\x03");
  EXPECT_EQ(say(dialogue, "sRA SCdevicestate 0"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sMN SetAccessMode 3 F4724744\x03");
  EXPECT_EQ(say(dialogue, "sAN SetAccessMode 1"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sMN LMCstartmeas\x03");
  EXPECT_EQ(say(dialogue, "sAN LMCstartmeas 0"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sMN Run\x03");
  EXPECT_EQ(say(dialogue, "sAN Run 1"), Effect::Next);
  EXPECT_EQ(say(dialogue, "sRA SCdevicestate 0"), Effect::AskLater) << "the motor is not at speed";
  EXPECT_EQ(as_text(dialogue.request()), "\x02sRN SCdevicestate\x03");
  EXPECT_EQ(say(dialogue, "sRA SCdevicestate 1"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sEN LMDscandata 1\x03");
  EXPECT_EQ(say(dialogue, "sEA LMDscandata 1"), Effect::Next);
  EXPECT_EQ(dialogue.step(), SickStep::Scans);
  EXPECT_THAT(dialogue.refusals(), testing::IsEmpty());
}

TEST(SickDialogue, ChangesNothingWhereItMayNotStart) {
  SickDialogue dialogue(ColaLanguage::A, false);
  say(dialogue, "sRA SCdevicestate 1");
  EXPECT_EQ(say(dialogue, "sRA SCdevicestate 1"), Effect::Next);
  EXPECT_EQ(as_text(dialogue.request()), "\x02sEN LMDscandata 1\x03");
}

TEST(SickDialogue, TakesNothingForAnAnswerThatIsNone) {
  SickDialogue dialogue(ColaLanguage::A, true);
  say(dialogue, "sRA SCdevicestate 1");
  EXPECT_EQ(say(dialogue, "sSN LMDscandata 1 1"), Effect::None);
  EXPECT_EQ(say(dialogue, "sRA SetAccessMode 1"), Effect::None);
  EXPECT_EQ(say(dialogue, "sAN SetAccessModeX 1"), Effect::None);
  EXPECT_EQ(dialogue.step(), SickStep::LogIn);
}

TEST(SickDialogue, GoesOnAfterARefusalAndSaysWhatItWas) {
  SickDialogue dialogue(ColaLanguage::A, true);
  EXPECT_EQ(say(dialogue, "sFA 3"), Effect::Next) << "whatever it says, it understood the language";
  EXPECT_EQ(say(dialogue, "sAN SetAccessMode 0"), Effect::Next);
  EXPECT_EQ(say(dialogue, "sFA 1"), Effect::Next);
  EXPECT_THAT(
      dialogue.refusals(),
      testing::ElementsAre("sMN SetAccessMode: answered 0",
                           "sMN LMCstartmeas: sFA 1 (access to the method denied at this user level: log "
                           "in first)"));
  EXPECT_EQ(dialogue.step(), SickStep::Run);
}

TEST(SickDialogue, GivesUpWhereScansAreRefused) {
  SickDialogue dialogue(ColaLanguage::A, false);
  say(dialogue, "sRA SCdevicestate 1");
  say(dialogue, "sRA SCdevicestate 1");
  EXPECT_EQ(say(dialogue, "sFA F"), Effect::Next);
  EXPECT_EQ(dialogue.step(), SickStep::Refused);
  EXPECT_THAT(dialogue.request(), testing::IsEmpty());
}

}  // namespace
}  // namespace crisp
