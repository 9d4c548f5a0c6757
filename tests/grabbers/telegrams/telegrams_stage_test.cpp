// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/telegrams_stage.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

#include <crisp/capture_reader.hpp>
#include <crisp/error.hpp>

#include "grabbers/wire/cola_encoding.hpp"
#include "grabbers/wire/scan_data.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::telegrams;
using namespace crisp::wire;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

/// Telegrams as they stand in a list, 20 ms apart.
class List {
 public:
  void add(const Bytes& telegram) {
    std::string hexadecimal;
    for (const std::uint8_t byte : telegram)
      hexadecimal += fmt::format("{}{:02x}", hexadecimal.empty() ? "" : ":", byte);
    text_ += fmt::format(
        R"({}{{"_source": {{"layers": {{"tcp": {{"Timestamps": {{"tcp.time_relative": "{}"}}, "tcp.payload": "{}"}}}}}}}})",
        text_.empty() ? "" : ",\n", 0.02 * count_++, hexadecimal);
  }
  void add_scan(std::uint16_t counter, std::vector<EncoderBlock> encoders = {}) {
    ScanData data;
    data.encoders = std::move(encoders);
    data.telegram_counter = data.scan_counter = counter;
    data.scan_time_us = 20'000U * counter;
    data.transmission_time_us = data.scan_time_us + 3000;
    data.channels16 = {{.start_angle = -450'000, .angle_step = 5000, .raw = {1000, 0, 3000}}};
    add(encode_scan_data(data, ColaLanguage::B));
  }
  std::string text() const { return "[" + text_ + "]"; }

 private:
  std::string text_;
  int count_ = 0;
};

class TelegramsStageTest : public testing::Test {
 protected:
  test::StageDriver stage(const std::string& text, const std::string& laser = "") {
    const auto file = folder_ / "list.json";
    std::ofstream(file) << text;
    return test::StageDriver::of<TelegramsStage>(
        {{"file", OptionScalar(file.string())}, {"laser", OptionScalar(laser)}});
  }

  test::TemporaryFolder folder_;
};

TEST_F(TelegramsStageTest, GivesTheReadingsOfAnEncoderThatIsWiredToTheLaser) {
  List list;
  for (const std::uint16_t k : {1, 2, 3}) list.add_scan(k, {{.position = 4294967294U + k}});
  auto driver = stage(list.text());
  driver.run().rig.plate.encoder_of = 0;
  driver.feed();
  const auto readings = driver.given<PlateReading>();
  ASSERT_EQ(readings.size(), 3U);
  EXPECT_EQ(readings[0]->count, 4294967295U);
  EXPECT_EQ(readings[2]->count, 1U);
  EXPECT_EQ(readings[2]->device_us, 60'000U);
  EXPECT_EQ(driver.given<Scan>().size(), 3U);
}

TEST_F(TelegramsStageTest, GivesEachScanOnce) {
  List list;
  list.add(cola_message("sMN", "SetAccessMode", {std::uint8_t{3}}, ColaLanguage::B));
  list.add_scan(1);
  list.add_scan(2);
  list.add_scan(2);
  list.add_scan(4);
  auto driver = stage(list.text(), "laser2");
  driver.check();
  driver.feed();
  const auto scans = driver.given<Scan>();
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans[0]->laser, 1);
  EXPECT_EQ(scans[0]->receipt_ns, 20'000'000);
  EXPECT_EQ(scans[2]->receipt_ns, 80'000'000);
  EXPECT_THAT(scans[0]->echoes.at(0).ranges, ElementsAre(1.0F, 0.0F, 3.0F));
  EXPECT_THAT(driver.report().counts,
              ElementsAre(Pair("items that came twice", 1), Pair("lost telegrams, by their counter", 1)));
  EXPECT_THAT(driver.report().warnings,
              ElementsAre(HasSubstr("list.json: 25.0 % of the telegrams of laser2")));
}

TEST_F(TelegramsStageTest, ReportsErrors) {
  List requests;
  requests.add(cola_message("sRN", "DeviceIdent", {}, ColaLanguage::B));
  const auto complaint = [&](const std::string& text, const std::string& laser) -> std::string {
    try {
      auto driver = stage(text, laser);
      driver.check();
      driver.feed();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(complaint(requests.text(), ""), HasSubstr("holds no scan"));
  EXPECT_THAT(complaint("[]", ""), HasSubstr("holds no scan"));
  EXPECT_THAT(complaint("[]", "laser9"), HasSubstr("no laser laser9"));
  EXPECT_THAT(complaint("nonsense", ""), HasSubstr("list.json:1:"));
}

TEST_F(TelegramsStageTest, OfARealLms111GivesWhatItsCaptureDoes) {
  const auto list = shared_data() / "sick/lms111-20210302-colab.json";
  const auto capture = shared_data() / "sick/lms111-20210302-colab-rebuilt.pcap";
  if (!std::filesystem::exists(list)) GTEST_SKIP() << "no shared data: " << list.filename();
  auto driver = test::StageDriver::of<TelegramsStage>({{"file", OptionScalar(list.string())}});
  driver.feed();
  const auto scans = driver.given<Scan>();
  CaptureReader reader(capture, default_rig());
  std::size_t k = 0;
  std::int64_t offset_ns = 0;
  while (const auto item = reader.next()) {
    const Scan& expected = *std::get<std::shared_ptr<const Scan>>(*item);
    ASSERT_LT(k, scans.size());
    if (k == 0) offset_ns = expected.receipt_ns - scans[0]->receipt_ns;
    EXPECT_EQ(scans[k]->scan_counter, expected.scan_counter);
    EXPECT_EQ(scans[k]->echoes.at(0).ranges, expected.echoes.at(0).ranges);
    EXPECT_NEAR(static_cast<double>(scans[k]->receipt_ns + offset_ns - expected.receipt_ns), 0, 2000)
        << "ns: the capture has whole microseconds";
    ++k;
  }
  EXPECT_EQ(k, scans.size());
  EXPECT_THAT(driver.report().counts, Contains(Pair("items that came twice", 3)));
}

}  // namespace
}  // namespace crisp
