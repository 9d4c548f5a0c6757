// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/scan_data.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include <crisp/error.hpp>

#include "tests/grabbers/wire/samples.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;
using testing::ElementsAre;

FieldFailure decode(const FoundTelegram& found, ScanData& data,
                    EncoderWidths widths = EncoderWidths::Position32) {
  const auto telegram = parse_cola(found.payload, found.language);
  EXPECT_TRUE(telegram);
  EXPECT_EQ(telegram->name, kScanDataName);
  return decode_scan_data(*telegram, widths, data);
}

ScanData decode_one(ByteView stream) {
  const auto found = find_telegrams(stream);
  ScanData data;
  EXPECT_EQ(found.size(), 1U);
  EXPECT_EQ(decode(found.at(0), data), FieldFailure::None);
  EXPECT_EQ(data.appended, 0U);
  return data;
}

int sum(const ChannelBlock& channel) { return std::accumulate(channel.raw.begin(), channel.raw.end(), 0); }

std::vector<int> ends(const ChannelBlock& channel, std::size_t first, std::size_t last) {
  std::vector<int> values(channel.raw.begin(), channel.raw.begin() + static_cast<std::ptrdiff_t>(first));
  values.insert(values.end(), channel.raw.end() - static_cast<std::ptrdiff_t>(last), channel.raw.end());
  return values;
}

TEST(ScanData, ReadsARealTelegramOfAnLms111) {
  const auto data = decode_one(real_telegram("lms111_scan.hex"));
  EXPECT_EQ(data.version, 1);
  EXPECT_EQ(data.device_number, 1);
  EXPECT_EQ(data.serial_number, 18090362U);
  EXPECT_EQ(data.device_status, 1);
  EXPECT_EQ(data.telegram_counter, 63336);
  EXPECT_EQ(data.scan_counter, 4);
  EXPECT_EQ(data.scan_time_us, 1948810585U);
  EXPECT_EQ(data.transmission_time_us, 1948813715U);
  EXPECT_EQ(data.digital_inputs, 0);
  EXPECT_EQ(data.digital_outputs, 1);
  EXPECT_EQ(data.scan_frequency, 5000U);
  EXPECT_EQ(data.measurement_frequency, 360U);
  EXPECT_TRUE(data.encoders.empty());
  ASSERT_EQ(data.channels16.size(), 1U);
  const auto& distances = data.channels16[0];
  EXPECT_EQ(distances.name, "DIST1");
  EXPECT_EQ(distances.scale, 1);
  EXPECT_EQ(distances.offset, 0);
  EXPECT_EQ(distances.start_angle, -450000);
  EXPECT_EQ(distances.angle_step, 5000);
  EXPECT_EQ(distances.raw.size(), 541U);
  EXPECT_THAT(ends(distances, 6, 6), ElementsAre(93, 80, 86, 89, 82, 90, 83, 80, 91, 90, 80, 77));
  EXPECT_EQ(sum(distances), 462019);
  EXPECT_TRUE(data.channels8.empty());
  EXPECT_FALSE(data.position || data.name || data.comment || data.event);
  EXPECT_EQ(data.time, (TimeBlock{1970, 1, 1, 2, 55, 34, 889000}));
}

TEST(ScanData, ReadsARealTelegramOfAnLms511WithRemissionsInEightBits) {
  const auto data = decode_one(real_telegram("lms511_scan.hex"));
  EXPECT_EQ(data.version, 0);
  EXPECT_EQ(data.serial_number, 18110550U);
  EXPECT_EQ(data.telegram_counter, 10203);
  EXPECT_EQ(data.scan_counter, 10335);
  EXPECT_EQ(data.scan_time_us, 1387959194U);
  EXPECT_EQ(data.transmission_time_us, 1387999963U);
  EXPECT_EQ(data.scan_frequency, 2500U);
  EXPECT_EQ(data.measurement_frequency, 540U);
  ASSERT_EQ(data.channels16.size(), 1U);
  ASSERT_EQ(data.channels8.size(), 1U);
  const auto& distances = data.channels16[0];
  EXPECT_EQ(distances.name, "DIST1");
  EXPECT_EQ(distances.start_angle, -50000);
  EXPECT_EQ(distances.angle_step, 1667);
  EXPECT_EQ(distances.raw.size(), 1141U);
  EXPECT_THAT(ends(distances, 5, 3), ElementsAre(1305, 1300, 1299, 1299, 1307, 624, 624, 627));
  EXPECT_EQ(sum(distances), 1476189);
  const auto& remissions = data.channels8[0];
  EXPECT_EQ(remissions.name, "RSSI1");
  EXPECT_EQ(remissions.raw.size(), 1141U);
  EXPECT_THAT(ends(remissions, 2, 3), ElementsAre(254, 254, 211, 210, 212));
  EXPECT_EQ(sum(remissions), 264433);
  ASSERT_TRUE(data.time);
  EXPECT_EQ(data.time->hour * 3600 + data.time->minute * 60 + data.time->second, 1 * 3600 + 34 * 60 + 39);
  EXPECT_EQ(data.time->microsecond, 489000U);
}

TEST(ScanData, ReadsTheManualsExampleInAscii) {
  const std::string text =
      "\x02sRA LMDscandata 1 1 89A27F 0 0 343 347 27477BA9 2747813B 0 0 7 0 0 1388 168 0 1 DIST1 3F800000 00000000 186A0 1388 15 8A1 8A5 8AB 8AC 8A6 8AC 8B6 8C8 8C2 8C9 8CB 8C4 8E4 8E1 8EB 8E0 8F5 908 8FC 907 906 0 0 0 0 0 0\x03";
  const auto data = decode_one(as_bytes(text));
  EXPECT_EQ(data.serial_number, 9020031U);
  EXPECT_EQ(data.telegram_counter, 835);
  EXPECT_EQ(data.scan_counter, 839);
  EXPECT_EQ(data.scan_time_us, 658996137U);
  EXPECT_EQ(data.transmission_time_us, 658997563U);
  EXPECT_EQ(data.digital_outputs, 7);
  EXPECT_EQ(data.scan_frequency, 5000U);
  EXPECT_EQ(measurement_frequency_hz(data), 36000);
  ASSERT_EQ(data.channels16.size(), 1U);
  EXPECT_EQ(data.channels16[0].scale, 1);
  EXPECT_EQ(data.channels16[0].start_angle, 100000);
  EXPECT_EQ(data.channels16[0].angle_step, 5000);
  EXPECT_EQ(data.channels16[0].raw.size(), 21U);
  EXPECT_THAT(ends(data.channels16[0], 1, 1), ElementsAre(2209, 2310));
  Bytes again;
  append_scan_data(data, ColaLanguage::A, "sRA", EncoderWidths::Position32, again);
  EXPECT_EQ(as_text(again), text);
}

TEST(ScanData, ReadsTheManualsExampleInBinary) {
  const auto bytes = from_hex(
      "02 02 02 02 00 00 00 83 73 52 41 20 4c 4d 44 73 63 61 6e 64 61 74 61 20 00 01 00 01 00 89 a2 7f 00 00 c8 c8 c8 cc 15 58 86 d8 15 58 8c 5a 00 00 07 00 00 00 00 00 13 88 00 00 01 68 00 00 00 01 44 49 53 54 31 3f 80 00 00 00 00 00 00 00 01 86 a0 13 88 00 15 08 93 08 95 08 af 08 b3 08 b0 08 a4 08 b0 08 bf 08 b9 08 ba 08 d0 08 d3 08 cf 08 de 08 eb 08 e3 08 fe 08 ec 09 03 08 fd 08 fd 00 00 00 00 00 00 00 00 00 00 00 00 2b");
  const auto data = decode_one(bytes);
  EXPECT_EQ(data.telegram_counter, 51400);
  EXPECT_EQ(data.scan_counter, 51404);
  EXPECT_EQ(data.scan_time_us, 358123224U);
  EXPECT_EQ(data.transmission_time_us, 358124634U);
  ASSERT_EQ(data.channels16.size(), 1U);
  EXPECT_EQ(data.channels16[0].raw.size(), 21U);
  EXPECT_THAT(ends(data.channels16[0], 1, 1), ElementsAre(2195, 2301));
  Bytes again;
  append_scan_data(data, ColaLanguage::B, "sRA", EncoderWidths::Position32, again);
  EXPECT_EQ(again, bytes);
}

TEST(ScanData, ReadsTheNameAndTimeOfARealTelegramInAscii) {
  const auto data = decode_one(as_bytes(
      "\x02sSN LMDscandata 1 1 89A27F 0 0 343 347 280F6 2867F 0 0 7 0 0 1388 168 0 1 DIST1 3F800000 00000000 186A0 1388 2 8A1 8A5 0 0 1 7 Derecha 0 1 7B2 1 1 0 2A 27 28870 0\x03"));
  EXPECT_TRUE(data.channels8.empty());
  EXPECT_FALSE(data.position);
  EXPECT_EQ(data.name, "Derecha");
  EXPECT_FALSE(data.comment);
  EXPECT_EQ(data.time, (TimeBlock{1970, 1, 1, 0, 42, 39, 166000}));
  EXPECT_FALSE(data.event);
}

class BothLanguages : public testing::TestWithParam<ColaLanguage> {};
INSTANTIATE_TEST_SUITE_P(, BothLanguages, testing::Values(ColaLanguage::A, ColaLanguage::B),
                         [](const auto& test) { return test.param == ColaLanguage::A ? "ColaA" : "ColaB"; });

TEST_P(BothLanguages, GiveBackEveryFieldOfEveryBlock) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    auto data = full_scan_data(seed);
    if (seed % 2 == 1) data.name.reset();
    if (seed % 3 == 1) data.comment = "no comment, two  spaces";
    if (seed % 5 == 1) data.position.reset();
    if (seed % 7 == 1) data.channels16.clear();
    EXPECT_EQ(decode_one(encode_scan_data(data, GetParam())), data);
  }
}

TEST_P(BothLanguages, GiveBackTheOtherWidthsOfEncoders) {
  auto data = full_scan_data(3);
  data.encoders = {{65535, 65535}};
  Bytes stream;
  append_scan_data(data, GetParam(), "sSN", EncoderWidths::Position16, stream);
  ScanData again;
  EXPECT_EQ(decode(find_telegrams(stream).at(0), again, EncoderWidths::Position16), FieldFailure::None);
  EXPECT_EQ(again, data);
}

TEST_P(BothLanguages, RefuseEveryTelegramThatEndsEarly) {
  const auto whole = find_telegrams(encode_scan_data(full_scan_data(4), GetParam())).at(0);
  const std::size_t begin = std::string_view("sSN LMDscandata ").size();
  ScanData data;
  for (std::size_t size = begin; size < whole.payload.size(); ++size) {
    auto cut = whole;
    cut.payload.resize(size);
    const bool last_digits = GetParam() == ColaLanguage::A && size + 8 > whole.payload.size();
    if (!last_digits) {  // a number without its last digits is a number still
      ASSERT_NE(decode(cut, data), FieldFailure::None) << size;
    }
  }
}

TEST_P(BothLanguages, CountFieldsThatANewerFirmwareAppends) {
  auto found = find_telegrams(encode_scan_data(full_scan_data(5), GetParam())).at(0);
  const std::string_view more = GetParam() == ColaLanguage::A ? " 1 2 FF" : "abc";
  found.payload.insert(found.payload.end(), more.begin(), more.end());
  ScanData data;
  EXPECT_EQ(decode(found, data), FieldFailure::None);
  EXPECT_EQ(data.appended, 3U);
}

TEST_P(BothLanguages, SurviveEveryFlippedBit) {
  const auto whole = find_telegrams(encode_scan_data(full_scan_data(6), GetParam())).at(0);
  const std::size_t begin = std::string_view("sSN LMDscandata ").size();
  ScanData data;
  std::size_t refused = 0;
  for (std::size_t bit = begin * 8; bit < whole.payload.size() * 8; ++bit) {
    auto damaged = whole;
    damaged.payload[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    const auto telegram = parse_cola(damaged.payload, damaged.language);
    if (decode_scan_data(*telegram, EncoderWidths::Position32, data) != FieldFailure::None) ++refused;
    for (const auto& channel : data.channels16) ASSERT_LE(channel.raw.size(), damaged.payload.size());
  }
  EXPECT_GT(refused, 0U);
}

TEST(ScanData, TakesLargeMeasurementFrequenciesAsHertz) {
  ScanData data;
  data.measurement_frequency = 18000;  // as an MRS1000 sends it
  EXPECT_EQ(measurement_frequency_hz(data), 18000);
  data.measurement_frequency = 540;
  EXPECT_EQ(measurement_frequency_hz(data), 54000);
}

TEST(ScanData, RefusesToWriteWhatDoesNotFitItsField) {
  const auto refused = [](auto change) {
    auto data = full_scan_data(0);
    change(data);
    EXPECT_THROW(encode_scan_data(data, ColaLanguage::B), Error);
  };
  refused([](ScanData& d) { d.channels16[0].name = "DIST"; });
  refused([](ScanData& d) { d.channels8[0].raw[0] = 256; });
  refused([](ScanData& d) { d.channels16[0].raw.resize(65536); });
  refused([](ScanData& d) { d.channels16[0].raw.resize(40000); });  // beyond a telegram's 64 KiB
  refused([](ScanData& d) { d.encoders[0].speed = 40000; });
  refused([](ScanData& d) { d.name = std::string(256, 'x'); });
  refused([](ScanData& d) { d.event->kind = "FD"; });
}

}  // namespace
}  // namespace crisp
