// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/telegram_list.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;
using testing::Pair;

std::string entry(const std::string& payload, const std::string& time) {
  return fmt::format(
      R"({{"_source": {{"layers": {{"tcp": {{"Timestamps": {{"tcp.time_relative": {}}}, "tcp.payload": {}}}}}}}}})",
      time, payload);
}

std::string complaint(const std::string& text) {
  Counts losses;
  try {
    read_telegram_list(text, "list.json", losses);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(TelegramList, GivesBytesAndTimes) {
  Counts losses;
  const auto list = read_telegram_list("[" + entry(R"("02:02:fF")", R"("0.25")") + ",\n" +
                                           entry(R"("00")", "1.5") + "," + entry(R"("")", R"("2e0")") + "]",
                                       "list.json", losses);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_THAT(list[0].bytes, ElementsAre(0x02, 0x02, 0xff));
  EXPECT_EQ(list[0].time_ns, 250'000'000);
  EXPECT_THAT(list[1].bytes, ElementsAre(0x00));
  EXPECT_EQ(list[1].time_ns, 1'500'000'000);
  EXPECT_TRUE(list[2].bytes.empty());
  EXPECT_TRUE(losses.all().empty());
}

TEST(TelegramList, CountsWhatCannotBeRead) {
  Counts losses;
  const std::string good = entry(R"("0a:0b")", R"("0.5")");
  const auto list = read_telegram_list(
      "[" + good + ", 7, null, {\"_source\": []}, " + entry("12", R"("0")") + "," + entry(R"("0x:0b")", "0") +
          "," + entry(R"("0a-0b")", "0") + "," + entry(R"("0a:0")", "0") + "," + entry(R"("0a0b")", "0") +
          "," + entry(R"("0a")", R"("soon")") + "," + entry(R"("0a")", "-1") + "," +
          entry(R"("0a")", "1e300") + "," + entry(R"("0a")", R"("nan")") + "," + entry(R"("0a")", "null") +
          "]",
      "list.json", losses);
  EXPECT_EQ(list.size(), 1U);
  EXPECT_THAT(losses.all(),
              ElementsAre(Pair("entries whose payload is not hexadecimal", 4),
                          Pair("entries without a payload", 4), Pair("entries without a time", 5)));
}

TEST(TelegramList, SaysWhereAFileIsNone) {
  EXPECT_THAT(complaint("[\n  {\"a\": 1},\n  {\"b\" 2}\n]"), testing::HasSubstr("list.json:3:8: "));
  EXPECT_THAT(complaint(""), testing::HasSubstr("list.json:1:1: "));
  EXPECT_THAT(complaint("[{\"a\": 1}"), testing::HasSubstr("this is no JSON"));
  EXPECT_THAT(complaint("{\"a\": 1}"), testing::HasSubstr("list of telegrams"));
  EXPECT_THAT(complaint(std::string(100'000, '[')), testing::HasSubstr("this is no JSON"));
}

}  // namespace
}  // namespace crisp
