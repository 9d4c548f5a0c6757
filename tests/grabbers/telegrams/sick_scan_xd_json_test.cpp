// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/sick_scan_xd_json.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>
#include <streambuf>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::telegrams;
using testing::ElementsAre;
using testing::Pair;

std::string entry(const std::string& payload, const std::string& time) {
  return fmt::format(
      R"({{"_source": {{"layers": {{"tcp": {{"Timestamps": {{"tcp.time_relative": {}}}, "tcp.payload": {}}}}}}}}})",
      time, payload);
}

std::vector<ListedTelegram> read(const std::string& text, Counts& losses) {
  std::istringstream stream(text);
  std::vector<ListedTelegram> list;
  read_telegram_list(stream, "list.json", losses,
                     [&](ListedTelegram each) { list.push_back(std::move(each)); });
  return list;
}

std::string complaint(const std::string& text) {
  Counts losses;
  try {
    read(text, losses);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(SickScanXdPackets, GivesBytesAndTimes) {
  Counts losses;
  const auto list = read("[" + entry(R"("02:02:fF")", R"("0.25")") + ",\n" + entry(R"("00")", "1.5") + "," +
                             entry(R"("")", R"("2e0")") + "]",
                         losses);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_THAT(list[0].bytes, ElementsAre(0x02, 0x02, 0xff));
  EXPECT_EQ(list[0].time_ns, 250'000'000);
  EXPECT_THAT(list[1].bytes, ElementsAre(0x00));
  EXPECT_EQ(list[1].time_ns, 1'500'000'000);
  EXPECT_TRUE(list[2].bytes.empty());
  EXPECT_TRUE(losses.all().empty());
}

TEST(SickScanXdPackets, CountsWhatCannotBeRead) {
  Counts losses;
  const std::string good = entry(R"("0a:0b")", R"("0.5")");
  const auto list =
      read("[" + good + ", 7, null, {\"_source\": []}, " + entry("12", R"("0")") + "," +
               entry(R"("0x:0b")", "0") + "," + entry(R"("0a-0b")", "0") + "," + entry(R"("0a:0")", "0") +
               "," + entry(R"("0a0b")", "0") + "," + entry(R"("0a")", R"("soon")") + "," +
               entry(R"("0a")", "-1") + "," + entry(R"("0a")", "1e300") + "," + entry(R"("0a")", R"("nan")") +
               "," + entry(R"("0a")", "null") + "]",
           losses);
  EXPECT_EQ(list.size(), 1U);
  EXPECT_THAT(losses.all(),
              ElementsAre(Pair("entries whose payload is not hexadecimal", 4),
                          Pair("entries without a payload", 4), Pair("entries without a time", 5)));
}

TEST(SickScanXdPackets, ReportsWhereAFileIsNone) {
  EXPECT_THAT(complaint("[\n  {\"a\": 1},\n  {\"b\" 2}\n]"), testing::HasSubstr("list.json:3:8: "));
  EXPECT_THAT(complaint(""), testing::HasSubstr("list.json:1:1: "));
  EXPECT_THAT(complaint("[{\"a\": 1}"), testing::HasSubstr("this is no JSON"));
  EXPECT_THAT(complaint("{\"a\": 1}"), testing::HasSubstr("list of telegrams"));
  EXPECT_THAT(complaint(std::string(100'000, '[')), testing::HasSubstr("this is no JSON"));
  EXPECT_THAT(complaint("[" + std::string(70'000, ' ') + "\n  x"), testing::HasSubstr("list.json:2:3: "));
  EXPECT_THAT(complaint("[" + std::string(200'000, ' ') + "x"), testing::HasSubstr("list.json:1:200002: "));
}

/// A text that never ends: a beginning, and then the same again and again.
class EndlessText final : public std::streambuf {
 public:
  EndlessText(std::string begin, std::string again) : text_(std::move(begin)), again_(std::move(again)) {}

 protected:
  int_type underflow() override {
    if (gptr() != nullptr) text_ = again_;
    setg(text_.data(), text_.data(), text_.data() + text_.size());
    return traits_type::to_int_type(*gptr());
  }

 private:
  std::string text_;
  std::string again_;
};

TEST(SickScanXdPackets, EndsWhatNeverComesToItsNextElement) {
  for (const std::string endless : {"a", " ", "\n"}) {
    EndlessText buffer("[\"", std::string(4096, endless[0]));
    std::istream text(&buffer);
    Counts losses;
    try {
      read_telegram_list(text, "list.json", losses, [](const ListedTelegram&) {});
      FAIL() << endless;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::AnyOf(testing::HasSubstr("an element of more than 64 MiB"),
                                               testing::HasSubstr("this is no JSON")));
    }
  }
}

TEST(SickScanXdPackets, HandsOnTelegramsBeforeTheListEnds) {
  EndlessText buffer("[" + entry(R"("0a")", "0"), ", " + entry(R"("0b")", "1"));
  std::istream text(&buffer);
  Counts losses;
  int telegrams = 0;
  const auto stop_after_many = [&](const ListedTelegram&) {
    if (++telegrams == 1000) throw Error("enough");
  };
  EXPECT_THROW(read_telegram_list(text, "list.json", losses, stop_after_many), Error);
  EXPECT_EQ(telegrams, 1000);
}

}  // namespace
}  // namespace crisp
