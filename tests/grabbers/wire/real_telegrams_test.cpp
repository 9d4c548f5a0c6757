// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "grabbers/wire/scan_conversion.hpp"
#include "tests/grabbers/wire/samples.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;

/// What the telegrams of one converted capture hold, read one after the other as one stream.
struct Capture {
  std::size_t entries = 0;
  ColaFramer::Counts counts;
  std::map<std::string, int> kinds;  ///< by command and name
  std::set<std::uint16_t> scans;     ///< different scan counters
  std::map<unsigned, int> errors;
  std::size_t written_back = 0;  ///< scans that encoding gives back byte for byte
};

class RealTelegrams : public testing::Test {
 protected:
  Capture read(const std::string& name) {
    Capture capture;
    std::ifstream file(shared_data() / "sick" / name);
    Bytes stream;
    for (const auto& entry : nlohmann::json::parse(file)) {
      const auto bytes = from_hex(entry["_source"]["layers"]["tcp"]["tcp.payload"].get<std::string>());
      stream.insert(stream.end(), bytes.begin(), bytes.end());
      ++capture.entries;
    }
    for (const auto& found : find_telegrams(stream, 1460, &capture.counts)) take(found, capture);
    return capture;
  }

  static bool missing(const std::string& name) {
    return !std::filesystem::exists(shared_data() / "sick" / name);
  }

 private:
  static void take(const FoundTelegram& found, Capture& capture) {
    const auto telegram = parse_cola(found.payload, found.language);
    ASSERT_TRUE(telegram);
    ++capture.kinds[std::string(telegram->command) + " " + std::string(telegram->name)];
    if (const auto code = cola_error_code(*telegram)) ++capture.errors[*code];
    if (telegram->name != kScanDataName || telegram->command != "sSN") return;
    ScanData data;
    ASSERT_EQ(decode_scan_data(*telegram, EncoderWidths::Position32, data), FieldFailure::None);
    EXPECT_EQ(data.appended, 0U);
    Scan scan;
    EXPECT_EQ(to_scan(data, 0, 0, scan), ScanFailure::None);
    capture.scans.insert(data.scan_counter);
    if (encode_scan_data(data, found.language) == cola_frame(found.payload, found.language))
      ++capture.written_back;
  }
};

TEST_F(RealTelegrams, OfAnLms111AllDecodeAndAreWrittenBackByteForByte) {
  if (missing("lms111-20210302-colab.json")) GTEST_SKIP() << "no shared data: lms111-20210302-colab.json";
  const auto capture = read("lms111-20210302-colab.json");
  EXPECT_EQ(capture.counts.telegrams, capture.entries);
  EXPECT_EQ(capture.counts.skipped_bytes, 0U);
  EXPECT_EQ(capture.counts.checksum_failures, 0U);
  EXPECT_EQ(capture.kinds.at("sSN LMDscandata"), 175);
  EXPECT_EQ(capture.scans.size(), 172U);
  EXPECT_EQ(capture.written_back, 175U);
}

TEST_F(RealTelegrams, OfAnLms511AllDecodeAndItsErrorsAreRead) {
  const auto cases = {std::tuple{"lms511-20210301-colab.json", 136, 18},
                      {"lms511-20210302-colab.json", 174, 0}};
  for (const auto& [name, scans, errors] : cases) {
    if (missing(name)) GTEST_SKIP() << "no shared data: " << name;
    auto capture = read(name);
    EXPECT_EQ(capture.counts.telegrams, capture.entries);
    EXPECT_EQ(capture.counts.skipped_bytes, 0U);
    EXPECT_EQ(capture.kinds["sSN LMDscandata"], scans);
    EXPECT_EQ(capture.written_back, static_cast<std::size_t>(scans));
    EXPECT_EQ(capture.errors[3], errors) << "unknown variable";
  }
}

TEST_F(RealTelegrams, WhoseNameMerelyBeginsLikeAScansAreNoScans) {
  if (missing("tim781s-lmdscandatamon-colab.json"))
    GTEST_SKIP() << "no shared data: tim781s-lmdscandatamon-colab.json";
  const auto capture = read("tim781s-lmdscandatamon-colab.json");
  EXPECT_EQ(capture.counts.skipped_bytes, 0U);
  EXPECT_EQ(capture.kinds.at("sSN LMDscandata"), 12);
  EXPECT_EQ(capture.kinds.at("sSN LMDscandatamon"), 12);
  EXPECT_EQ(capture.written_back, 12U);
}

TEST_F(RealTelegrams, InAsciiAreFramed) {
  if (missing("rms1xxx-20221018-colaa.json")) GTEST_SKIP() << "no shared data: rms1xxx-20221018-colaa.json";
  const auto capture = read("rms1xxx-20221018-colaa.json");
  EXPECT_EQ(capture.counts.telegrams, capture.entries);
  EXPECT_EQ(capture.counts.skipped_bytes, 0U);
  EXPECT_EQ(capture.kinds.at("sSN LMDradardata"), 1);
}

}  // namespace
}  // namespace crisp
