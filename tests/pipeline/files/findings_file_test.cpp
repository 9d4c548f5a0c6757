// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/findings_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/pipeline/files/errors_of.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;

Findings some_findings() {
  Findings findings{.before_p = 0.005, .after_p = 0.6};
  findings.findings.push_back(
      {.cause = "mirror.cone",
       .scope = "laser2",
       .parameters = {{"kappa", "rad", 0.003, 1e-4, true}},
       .explained_fraction = 0.8,
       .log10_bayes_factor = 12,
       .p_value = 1e-9,
       .confounded_with = {"laser2.mount.tangential_offset"},
       .resolvable_by = {"surfaces near and far"},
       .alternatives = {{"range.offset", "laser3", 1.5}},
       .gain = {{.metric = "cloud thickness",
                 .unit = "m",
                 .before = 0.009,
                 .after = 0.0088,
                 .ci95 = {-3e-4, -1e-4}}},
       .tests = {{.name = "Wald test", .statistic = 40, .threshold = 1e-3, .p_value = 1e-9, .passed = true}},
       .accepted = true});
  findings.unnamed.push_back({.covariate = "mirror angle",
                              .quantity = "range",
                              .scope = "laser1",
                              .amplitude = 0.002,
                              .unit = "m",
                              .p_value = 1e-4});
  findings.departures.push_back({.covariate = "remission",
                                 .quantity = "range",
                                 .scope = "scanner",
                                 .amplitude = 0.004,
                                 .unit = "m",
                                 .p_value = 1e-12,
                                 .amplitude_after = 2e-4});
  findings.unobservable.push_back({.parameter = "encoder.backlash", .reason = "no reversal"});
  findings.artifacts.push_back({.name = "density",
                                .parameters = {{"laser2.tau", "m", 0.002, 1e-4, true}},
                                .reason = "an entropy's optimum shifts"});
  findings.devices.push_back({.device = "laser1", .stamps = 172, .skew = 7e-6});
  findings.noise.push_back({.laser = "laser1", .ranges = 31'000, .sigma = 4.6e-3});
  findings.gain = findings.findings[0].gain;
  return findings;
}

std::vector<std::string> keys_of(const nlohmann::json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(FindingsFile, HasItsDocumentedSchema) {
  const auto json = nlohmann::json::parse(findings_json(some_findings()));
  EXPECT_THAT(keys_of(json),
              testing::UnorderedElementsAre("crisp", "findings", "unnamed", "departures", "unobservable",
                                            "artifacts", "devices", "noise", "gain", "goodness_of_fit"));
  const auto& finding = json["findings"][0];
  EXPECT_THAT(keys_of(finding), testing::UnorderedElementsAre(
                                    "cause", "scope", "parameters", "explained_fraction",
                                    "log10_bayes_factor", "p_value", "confounded_with", "resolvable_by",
                                    "alternatives", "gain", "tests", "accepted", "rejection_reason"));
  EXPECT_THAT(keys_of(finding["tests"][0]),
              testing::UnorderedElementsAre("name", "statistic", "threshold", "p_value", "passed"));
  EXPECT_THAT(keys_of(finding["alternatives"][0]),
              testing::UnorderedElementsAre("cause", "scope", "log10_bayes_factor"));
  EXPECT_THAT(keys_of(json["departures"][0]),
              testing::UnorderedElementsAre("covariate", "quantity", "scope", "amplitude", "unit", "p_value",
                                            "amplitude_after", "p_value_after"));
  EXPECT_TRUE(json["departures"][0]["p_value_after"].is_null()) << "nothing was extended";
  EXPECT_THAT(keys_of(finding["parameters"][0]),
              testing::UnorderedElementsAre("name", "value", "unit", "std_error"));
  EXPECT_THAT(keys_of(finding["gain"][0]),
              testing::UnorderedElementsAre("metric", "unit", "before", "after", "ci95"));
  EXPECT_EQ(finding["gain"][0]["ci95"][1], -1e-4);
  EXPECT_EQ(json["unnamed"][0]["covariate"], "mirror angle");
  EXPECT_EQ(json["unobservable"][0]["cause"], "encoder.backlash");
  EXPECT_EQ(json["devices"][0]["skew"], 7e-6);
  EXPECT_EQ(json["goodness_of_fit"]["before_p"], 0.005);
}

TEST(FindingsFile, HoldsSeveralDiagnoses) {
  Findings all = some_findings();
  all.append(some_findings());
  all.append({.before_p = 0.5, .after_p = 0.1});
  const auto json = nlohmann::json::parse(findings_json(all));
  for (const char* list :
       {"findings", "unnamed", "departures", "unobservable", "artifacts", "devices", "noise", "gain"}) {
    EXPECT_EQ(json[list].size(), 2U) << list;
  }
  // The less of two: 1 - (1 - 0.005)^2 = 0.009975, then 1 - (1 - 0.009975)^2.
  EXPECT_NEAR(json["goodness_of_fit"]["before_p"], 0.0198505, 1e-9);
  EXPECT_NEAR(json["goodness_of_fit"]["after_p"], 0.19, 1e-9) << "some_findings() were not tested";
}

TEST(FindingsFile, IsDocumentedKeyByKey) {
  std::ifstream page(source_dir() + "/docs/reference/diagnosis-json.md");
  std::ostringstream text;
  text << page.rdbuf();
  const auto json = nlohmann::json::parse(findings_json(some_findings()));
  std::vector<nlohmann::json> objects = {json,
                                         json["findings"][0],
                                         json["findings"][0]["parameters"][0],
                                         json["findings"][0]["gain"][0],
                                         json["findings"][0]["alternatives"][0],
                                         json["unnamed"][0],
                                         json["departures"][0],
                                         json["unobservable"][0],
                                         json["artifacts"][0],
                                         json["devices"][0],
                                         json["noise"][0],
                                         json["goodness_of_fit"]};
  for (const auto& object : objects) {
    for (const auto& key : keys_of(object)) {
      EXPECT_THAT(text.str(), testing::HasSubstr("`" + key + "`"));
    }
  }
}

TEST(FindingsFile, IsReadAsItWasWritten) {
  Findings written = some_findings();
  written.findings[0].parameters.push_back({"P", "m", 0.1 + 0.2, std::nan(""), true});
  written.findings[0].parameters.push_back({.name = "T", .unit = "s", .value = 60});
  const Findings read = parse_findings(parse_yaml(findings_json(written), "diagnosis.json"));
  EXPECT_EQ(findings_json(read), findings_json(written));
  ASSERT_EQ(read.findings.size(), 1U);
  const Finding& finding = read.findings[0];
  EXPECT_EQ(finding.cause, "mirror.cone");
  EXPECT_EQ(finding.scope, "laser2");
  ASSERT_EQ(finding.parameters.size(), 3U);
  EXPECT_EQ(finding.parameters[0].value, 0.003);
  EXPECT_EQ(finding.parameters[1].value, 0.1 + 0.2) << "every digit";
  EXPECT_TRUE(std::isnan(finding.parameters[1].std_error)) << "null";
  EXPECT_TRUE(std::isnan(finding.parameters[2].std_error)) << "missing: not 0";
  EXPECT_EQ(finding.gain.at(0).ci95[0], -3e-4);
  EXPECT_TRUE(finding.accepted);
  EXPECT_EQ(finding.rejection_reason(), "");
  EXPECT_EQ(read.unnamed.at(0).quantity, "range");
  EXPECT_EQ(finding.alternatives.at(0).scope, "laser3");
  EXPECT_EQ(read.departures.at(0).amplitude, 0.004);
  EXPECT_TRUE(std::isnan(read.departures.at(0).p_value_after)) << "null";
  EXPECT_EQ(read.unobservable.at(0).parameter, "encoder.backlash");
  EXPECT_EQ(read.artifacts.at(0).parameters.at(0).value, 0.002);
  EXPECT_EQ(read.devices.at(0).stamps, 172U);
  EXPECT_EQ(read.noise.at(0).sigma, 4.6e-3);
  EXPECT_EQ(read.before_p, 0.005);
}

TEST(FindingsFile, ReportsWhyACauseWasRefused) {
  Findings written = some_findings();
  written.findings[0].accepted = false;
  const auto printed = [&] {
    return nlohmann::json::parse(findings_json(written))["findings"][0]["rejection_reason"]
        .get<std::string>();
  };
  EXPECT_THAT(printed(), testing::HasSubstr("does not improve the fit"));
  written.findings[0].rejection = "more is left than it takes";
  EXPECT_EQ(printed(), "more is left than it takes");
  const Findings read = parse_findings(parse_yaml(findings_json(written), "diagnosis.json"));
  EXPECT_EQ(read.findings.at(0).rejection_reason(), "more is left than it takes");
}

TEST(FindingsFile, HasTheTestsThatDecided) {
  const Findings read = parse_findings(parse_yaml(findings_json(some_findings()), "diagnosis.json"));
  ASSERT_THAT(read.findings.at(0).tests, testing::SizeIs(1));
  const AcceptanceTest& test = read.findings[0].tests[0];
  EXPECT_EQ(test.name, "Wald test");
  EXPECT_EQ(test.statistic, 40);
  EXPECT_EQ(test.threshold, 1e-3);
  EXPECT_EQ(test.p_value, 1e-9);
  EXPECT_TRUE(test.passed);
}

TEST(FindingsFile, OfAnEarlierVersionIsReadWithoutMissingKeys) {
  auto json = nlohmann::ordered_json::parse(findings_json(some_findings()));
  json.erase("departures");
  json["findings"][0].erase("alternatives");
  json["findings"][0].erase("tests");
  json["findings"][0].erase("refused");
  const Findings read = parse_findings(parse_yaml(json.dump(2), "diagnosis.json"));
  EXPECT_THAT(read.departures, testing::IsEmpty());
  EXPECT_EQ(read.findings.at(0).cause, "mirror.cone");
}

TEST(FindingsFile, ReplacesBytesThatAreNoUtf8) {
  Findings written = some_findings();
  written.devices[0].device = "caf\xe9";
  EXPECT_EQ(parse_findings(parse_yaml(findings_json(written), "diagnosis.json")).devices.at(0).device,
            "caf\xef\xbf\xbd");
}

std::vector<std::string> complaints(const std::string& text) {
  return errors_of([&] { parse_findings(parse_yaml(text, "diagnosis.json")); });
}

/// findings_json() of some findings with a part of it replaced.
std::string with(const std::string& part, const std::string& other) {
  std::string text = findings_json(some_findings());
  const auto at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), other);
}

TEST(FindingsFile, ThatIsDamagedIsRefusedWithTheLine) {
  using testing::AllOf;
  using testing::ElementsAre;
  using testing::HasSubstr;
  EXPECT_THAT(
      complaints(with("\"laser2\"", "[1]")),
      ElementsAre(AllOf(HasSubstr("diagnosis.json:6:"), HasSubstr("findings[0]"), HasSubstr("scope"))));
  EXPECT_THAT(complaints(with("0.003", "\"much\"")),
              ElementsAre(AllOf(HasSubstr("findings[0], parameters[0]"), HasSubstr("'much'"))));
  EXPECT_THAT(complaints(with("\"accepted\": true", "\"acepted\": true")),
              ElementsAre(HasSubstr("'accepted' is missing"), HasSubstr("did you mean 'accepted'?")));
  EXPECT_THAT(complaints(with("\"gain\": [", "\"gain\": {}, \"was\": [")),
              testing::Contains(HasSubstr("'gain': a map is not a list")));
  EXPECT_THAT(complaints(with("\"crisp\": 1", "\"crisp\": 2")), ElementsAre(HasSubstr("use a newer crisp")));
  const std::string whole = findings_json(some_findings());
  EXPECT_FALSE(complaints(whole.substr(0, whole.size() / 2)).empty());
  EXPECT_FALSE(complaints("").empty());
  const std::filesystem::path cut = std::filesystem::temp_directory_path() / "crisp-cut-diagnosis.json";
  std::ofstream(cut) << whole.substr(0, whole.size() / 2);
  EXPECT_THAT(errors_of([&] { read_findings(cut); }),
              ElementsAre(cut.string() + ": error: this is not JSON; it was truncated, or edited"));
  std::filesystem::remove(cut);
  EXPECT_THAT(errors_of([] { read_findings("nowhere/diagnosis.json"); }),
              ElementsAre(HasSubstr("nowhere/diagnosis.json")));
}

}  // namespace
}  // namespace crisp
