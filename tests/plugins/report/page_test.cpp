// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/page.hpp"

#include <gmock/gmock.h>

#include "tests/plugins/report/decoded_cloud.hpp"

namespace crisp {
namespace {

using namespace crisp::report;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

constexpr const char* kAttack = "<img src=x onerror=alert(1)></script><script>alert(2)</script>";

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const auto from = text.find(begin) + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

std::string page_of(const std::string& name) {
  return page_html({.title = name,
                    .data = {{"kind", "run"}, {"summary", {{"stages", Json::array()}, {"rig", name}}}},
                    .plots = {{.name = name, .svg = "<svg>" + name + "</svg>"}},
                    .cloud = {}});
}

TEST(Page, HoldsNoMarkupOfNamesInData) {
  const std::string page = page_of(kAttack), plain = page_of("plain");
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_EQ(count(page, "<script"), count(plain, "<script"));
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
}

TEST(Page, GivesItsScriptsTheDataAsTheyWere) {
  const std::string json = between(page_of(kAttack), R"(id="report-data">)", "</script>");
  const Json data = Json::parse(json);
  EXPECT_EQ(data.at("title"), kAttack);
  EXPECT_EQ(data.at("summary").at("rig"), kAttack);
  const std::string uri = data.at("plots").at(0).at("svg");
  EXPECT_EQ(test::decoded_base64(uri.substr(uri.find(',') + 1)), std::string("<svg>") + kAttack + "</svg>");
}

TEST(Page, ShowsTextThatIsNoUtf8WithReplacements) {
  const std::string json = between(page_of("caf\xE9"), R"(id="report-data">)", "</script>");
  EXPECT_EQ(Json::parse(json).at("title"), "caf\xEF\xBF\xBD");
}

TEST(Page, NamesNoAddressThatWouldBeLoaded) {
  const std::string page = page_of("plain");
  for (const char* part : {"src=\"http", "href=\"http", "@import", "fetch(", "XMLHttpRequest", "import("})
    EXPECT_THAT(page, Not(HasSubstr(part)));
  for (auto at = page.find("url("); at != std::string::npos; at = page.find("url(", at + 1))
    EXPECT_EQ(page.substr(at, 5), "url(#") << "a part of the page itself";
}

TEST(Page, LetsTheBrowserRunItsOwnScriptOnly) {
  const std::string policy = between(page_of("plain"), "Content-Security-Policy\" content=\"", "\"");
  EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
  EXPECT_THAT(policy, HasSubstr("script-src 'sha256-"));
  EXPECT_THAT(policy, Not(HasSubstr("script-src 'unsafe-inline'")));
}

TEST(Page, HoldsTheCloudWhereThereIsOne) {
  EXPECT_THAT(page_of("plain"), Not(HasSubstr(R"(id="report-cloud">)")));
  ShownCloud cloud{.after = {.x = {1.5}, .y = {2}, .z = {3}},
                   .laser = {0},
                   .beam = {7},
                   .remission = {9},
                   .time = {1},
                   .distance = {0},
                   .of = 1};
  const EncodedCloud encoded = encode(cloud);
  const std::string page = page_html({.title = "t", .data = Json::object(), .plots = {}, .cloud = encoded});
  EXPECT_EQ(between(page, R"(id="report-cloud">)", "</script>"), encoded.base64);
  EXPECT_EQ(Json::parse(between(page, R"(id="report-data">)", "</script>")).at("cloud"), encoded.header);
}

TEST(HtmlText, EscapesWhatMarkupConsistsOf) { EXPECT_EQ(html_text("a<b>&\"c"), "a&lt;b&gt;&amp;&quot;c"); }

}  // namespace
}  // namespace crisp
