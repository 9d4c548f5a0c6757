// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/emulate/sick_responder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grabbers/wire/cola_framer.hpp"

namespace crisp {
namespace {

using namespace crisp::emulate;
using namespace crisp::wire;
using namespace std::string_literals;

/// The answer to a request, without framing.
std::string answer_to(SickResponder& responder, const std::string& request, ColaLanguage language) {
  const auto parsed = parse_cola(as_bytes(request), language);
  EXPECT_TRUE(parsed) << request;
  std::string answer;
  ColaFramer framer;
  framer.feed(responder.answer(*parsed), 0, [&](const ColaFrame& frame) {
    EXPECT_EQ(frame.language, language) << request;
    answer += as_text(frame.payload);
  });
  return answer;
}

TEST(SickResponder, RunsTheAsciiDialogueOfLibLms1xxToItsEnd) {
  EmulatedDevice device;
  device.measuring = false;
  SickResponder responder(device);
  const auto a = [&](const std::string& request) { return answer_to(responder, request, ColaLanguage::A); };
  EXPECT_EQ(a("sMN SetAccessMode 03 F4724744"), "sAN SetAccessMode 1");
  EXPECT_EQ(a("sMN LMCstopmeas"), "sAN LMCstopmeas 0");
  EXPECT_EQ(a("sRN LMPscancfg"), "sRA LMPscancfg 1388 1 1388 FFF92230 225510");
  EXPECT_EQ(a("sRN LMPoutputRange"), "sRA LMPoutputRange 1 1388 FFF92230 225510");
  EXPECT_EQ(a("sWN LMDscandatacfg 01 00 1 1 0 00 00 0 0 0 0 +1"), "sWA LMDscandatacfg");
  EXPECT_THAT(a("sRN STlms"), testing::StartsWith("sRA STlms 3 "));
  EXPECT_EQ(a("sMN LMCstartmeas"), "sAN LMCstartmeas 0");
  EXPECT_THAT(a("sRN STlms"), testing::StartsWith("sRA STlms 7 "));
  EXPECT_EQ(a("sMN Run"), "sAN Run 1");
  EXPECT_FALSE(responder.wants_scans());
  EXPECT_EQ(a("sEN LMDscandata 1"), "sEA LMDscandata 1");
  EXPECT_TRUE(responder.wants_scans());
  EXPECT_EQ(responder.language(), ColaLanguage::A);
  EXPECT_EQ(a("sEN LMDscandata 0"), "sEA LMDscandata 0");
  EXPECT_FALSE(responder.wants_scans());
}

TEST(SickResponder, RunsTheBinaryDialogueOfSickScanXdToItsEnd) {
  EmulatedDevice device;
  SickResponder responder(device);
  const auto b = [&](const std::string& request) { return answer_to(responder, request, ColaLanguage::B); };
  EXPECT_EQ(b("sRN SCdevicestate"), "sRA SCdevicestate \x01"s);
  EXPECT_EQ(b("sMN SetAccessMode \x03\xf4\x72\x47\x44"), "sAN SetAccessMode \x01");
  EXPECT_EQ(b("sWN EIHstCola \x01"), "sWA EIHstCola ");
  EXPECT_EQ(b("sRN FirmwareVersion"), "sRA FirmwareVersion \0\x07V1.80.2"s);
  EXPECT_EQ(b("sRN ODoprh").size(), 15U);
  EXPECT_EQ(b("sRN ODpwrc").size(), 15U);
  EXPECT_EQ(b("sRN LocationName"), "sRA LocationName \0\x0bnot defined"s);
  EXPECT_EQ(b("sRN LMPoutputRange"), "sRA LMPoutputRange \0\x01\0\0\x13\x88\xff\xf9\x22\x30\0\x22\x55\x10"s);
  EXPECT_EQ(b("sWN LMPoutputRange \0\x01\0\0\x13\x88\xff\xf9\x22\x30\0\x22\x55\x10"s), "sWA LMPoutputRange ");
  EXPECT_EQ(b("sRN field000"), "sRA field000 \0"s) << "as a real LMS111 does; a driver gives up on an error";
  EXPECT_EQ(b("sRN field047"), "sRA field047 \0"s);
  EXPECT_EQ(b("sRN field048"), "sFA\0\x03"s);
  EXPECT_EQ(b("sRN field0xx"), "sFA\0\x03"s);
  EXPECT_EQ(b("sRN LIDinputstate"), "sRA LIDinputstate "s + std::string(12, '\0'));
  EXPECT_EQ(b("sRN LFErec"),
            "sRA LFErec \0\1\0\1\1\0\0\0\0\x3f\x80\0\0\0\0\0\0\0\0\x13\x88\xff\xf9\x22\x30\0"s +
                std::string(8, '\0'))
      << "one field: a driver takes none for damage";
  device.last.serial_number = 11110042;
  EXPECT_EQ(b("sRN SerialNumber"), "sRA SerialNumber \0\x08"s + "11110042");
  EXPECT_EQ(b("sWN LMDscandatacfg \x01\0\0\0\0\0\0\0\0\0\0\0\x01"s), "sWA LMDscandatacfg ");
  EXPECT_THAT(b("sRN LMDscandatacfg"), testing::SizeIs(19 + 13));
  EXPECT_THAT(b("sMN mLMPsetscancfg \0\0\x13\x88\0\x01\0\0\x13\x88\xff\xf9\x22\x30\0\x22\x55\x10"s),
              testing::StartsWith("sAN mLMPsetscancfg \0\0\0\x13\x88"s));
  EXPECT_EQ(b("sEN LFErec \x01"), "sEA LFErec \x01");
  EXPECT_EQ(b("sEN LIDoutputstate \x01"), "sEA LIDoutputstate \x01");
  EXPECT_EQ(b("sMN LMCstartmeas"), "sAN LMCstartmeas \0"s);
  EXPECT_EQ(b("sMN Run"), "sAN Run \x01");
  EXPECT_EQ(b("sEN LMDscandata \x01"), "sEA LMDscandata \x01");
  EXPECT_TRUE(responder.wants_scans());
}

TEST(SickResponder, RefusesAsADeviceDoes) {
  EmulatedDevice device;
  SickResponder responder(device);
  const auto a = [&](const std::string& request) { return answer_to(responder, request, ColaLanguage::A); };
  EXPECT_EQ(a("sMN LMCstopmeas"), "sFA 1") << "nobody is logged in";
  EXPECT_TRUE(device.measuring);
  EXPECT_EQ(a("sWN LMPoutputRange 1 1388 0 0"), "sFA A");
  EXPECT_EQ(a("sMN SetAccessMode 3 12345678"), "sAN SetAccessMode 0");
  EXPECT_EQ(a("sMN Dance"), "sFA 2");
  EXPECT_EQ(a("sEN Weather 1"), "sFA F");
  EXPECT_EQ(a("sXX LMDscandata"), "sFA C");
}

TEST(SickResponder, PutsInForceWhatIsConfiguredAsFarAsItsScansAllow) {
  EmulatedDevice device;
  device.last.channels16 = {{.name = "DIST1",
                             .start_angle = -450'000,
                             .angle_step = 5000,
                             .raw = std::vector<std::uint16_t>(541, 1)},
                            {.name = "RSSI1",
                             .start_angle = -450'000,
                             .angle_step = 5000,
                             .raw = std::vector<std::uint16_t>(541, 2)}};
  SickResponder responder(device);
  const auto a = [&](const std::string& request) { return answer_to(responder, request, ColaLanguage::A); };
  a("sMN SetAccessMode 03 F4724744");
  EXPECT_EQ(a("sMN mLMPsetscancfg 1388 1 1388 FFF92230 225510"),
            "sAN mLMPsetscancfg 0 1388 1 1388 FFF92230 225510");
  EXPECT_EQ(a("sMN mLMPsetscancfg +2500 +1 +2500 -450000 +2250000"),
            "sAN mLMPsetscancfg 3 1388 1 1388 FFF92230 225510")
      << "neither is possible, and what is in force";
  EXPECT_EQ(a("sMN mLMPsetscancfg 1388 1 2710 FFF92230 225510"),
            "sAN mLMPsetscancfg 0 1388 1 2710 FFF92230 225510")
      << "every second beam";
  EXPECT_EQ(device.sent(device.last).channels16[0].raw.size(), 271U);
  EXPECT_EQ(device.sent(device.last).channels16[0].angle_step, 10'000);
  EXPECT_EQ(a("sRN LMPscancfg"), "sRA LMPscancfg 1388 1 2710 FFF92230 225510");
  EXPECT_EQ(a("sMN mLMPsetscancfg 1388 1 1388 FFF92230 225510"),
            "sAN mLMPsetscancfg 0 1388 1 1388 FFF92230 225510");
  EXPECT_EQ(a("sWN LMPoutputRange 1 1388 225510 0"), "sFA 4");
  EXPECT_EQ(a("sWN LMPoutputRange"), "sFA 5");
  EXPECT_EQ(a("sWN LMPoutputRange 1 1388 0 3A98"), "sWA LMPoutputRange");
  EXPECT_EQ(a("sRN LMPoutputRange"), "sRA LMPoutputRange 1 1388 0 3A98");
  EXPECT_EQ(a("sWN LMDscandatacfg 1 0 0 1 0 0 0 0 0 0 0 1"), "sWA LMDscandatacfg");
  const ScanData sent = device.sent(device.last);
  ASSERT_EQ(sent.channels16.size(), 1U) << "no remissions";
  EXPECT_EQ(sent.channels16[0].start_angle, 0);
  EXPECT_EQ(sent.channels16[0].raw.size(), 4U) << "0, 0.5, 1 and 1.5 degrees";
}

TEST(SickResponder, AnswersHowItsScansAreBeforeAnybodyConfiguresThem) {
  EmulatedDevice device;
  device.last.scan_frequency = 2500;
  device.last.channels16 = {
      {.name = "DIST1", .start_angle = -450'000, .angle_step = 2500, .raw = std::vector<std::uint16_t>(1081)},
      {.name = "RSSI1",
       .start_angle = -450'000,
       .angle_step = 2500,
       .raw = std::vector<std::uint16_t>(1081)}};
  device.last.encoders.resize(1);
  SickResponder responder(device);
  const auto a = [&](const std::string& request) { return answer_to(responder, request, ColaLanguage::A); };
  EXPECT_EQ(a("sRN LMPscancfg"), "sRA LMPscancfg 9C4 1 9C4 FFF92230 225510") << "25 Hz, 0.25 degrees";
  EXPECT_EQ(a("sRN LMDscandatacfg"), "sRA LMDscandatacfg 1 0 1 1 0 1 0 0 0 0 0 1");
}

TEST(SickResponder, SendsEncoderAndScansAsConfigured) {
  EmulatedDevice device;
  device.last.channels16 = {{.name = "DIST1", .angle_step = 5000, .raw = {1000, 2000}}};
  device.last.encoders = {{.position = 7}};
  SickResponder responder(device);
  const auto a = [&](const std::string& request) { return answer_to(responder, request, ColaLanguage::A); };
  a("sMN SetAccessMode 03 F4724744");
  a("sWN LMDscandatacfg 1 0 0 0 0 1 0 0 0 0 0 3");
  EXPECT_EQ(device.sent(device.last).encoders.size(), 1U);
  int sent = 0;
  for (std::uint16_t k = 0; k < 9; ++k) {
    device.last.scan_counter = k;
    sent += device.sends(device.last) ? 1 : 0;
  }
  EXPECT_EQ(sent, 3);
  a("sWN LMDscandatacfg 1 0 0 0 0 0 0 0 0 0 0 1");
  EXPECT_TRUE(device.sent(device.last).encoders.empty());
}

TEST(SickResponder, SendsRemissionsAndTimeAsConfigured) {
  EmulatedDevice device;
  device.last.scan_time_us = 3'723'456'789;  // 1 h 2 min 3.456789 s
  device.last.channels16 = {{.name = "DIST1", .angle_step = 5000, .raw = {1000, 2000}}};
  device.last.channels8 = {{.name = "RSSI1", .angle_step = 5000, .raw = {7, 254}}};
  SickResponder responder(device);
  const auto a = [&](const std::string& request) { return answer_to(responder, request, ColaLanguage::A); };
  a("sMN SetAccessMode 03 F4724744");
  a("sWN LMDscandatacfg 1 0 1 1 0 0 0 0 0 0 1 1");
  const ScanData wide = device.sent(device.last);
  ASSERT_EQ(wide.channels16.size(), 2U);
  EXPECT_TRUE(wide.channels8.empty());
  EXPECT_EQ(wide.channels16[1].raw[1] * wide.channels16[1].scale, 254);
  ASSERT_TRUE(wide.time);
  EXPECT_EQ(*wide.time, (TimeBlock{.hour = 1, .minute = 2, .second = 3, .microsecond = 456'000}));
  a("sWN LMDscandatacfg 1 0 1 0 0 0 0 0 0 0 0 1");
  const ScanData narrow = device.sent(wide);
  ASSERT_EQ(narrow.channels8.size(), 1U);
  EXPECT_THAT(narrow.channels8[0].raw, testing::ElementsAre(7, 254));
  EXPECT_EQ(narrow.channels8[0].scale, 1);
  EXPECT_FALSE(narrow.time);
}

TEST(SickResponder, AnswersTheLastScanToWhoRequestsOne) {
  EmulatedDevice device;
  device.last.serial_number = 4711;
  SickResponder responder(device);
  const std::string answer = answer_to(responder, "sRN LMDscandata", ColaLanguage::A);
  EXPECT_THAT(answer, testing::StartsWith("sRA LMDscandata 1 1 1267 "));
}

}  // namespace
}  // namespace crisp
