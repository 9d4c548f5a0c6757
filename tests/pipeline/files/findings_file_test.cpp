// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/findings_file.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace crisp {
namespace {

Findings some_findings() {
  Findings findings{.before_p = 0.005, .after_p = 0.6};
  findings.findings.push_back({.cause = "mirror.cone",
                               .scope = "laser2",
                               .parameters = {{"kappa", "rad", 0.003, 1e-4, true}},
                               .explained_fraction = 0.8,
                               .log10_odds = 12,
                               .p_value = 1e-9,
                               .confounded_with = {"laser2.mount.tangential_offset"},
                               .gain = {{.metric = "cloud thickness",
                                         .unit = "m",
                                         .before = 0.009,
                                         .after = 0.0088,
                                         .ci95 = {-3e-4, -1e-4}}},
                               .accepted = true});
  findings.unnamed.push_back({.covariate = "mirror angle",
                              .quantity = "range",
                              .scope = "laser1",
                              .amplitude = 0.002,
                              .unit = "m",
                              .p_value = 1e-4});
  findings.unobservable.push_back({.parameter = "encoder.backlash", .reason = "no reversal"});
  findings.devices.push_back({.device = "laser1", .stamps = 172, .skew = 7e-6});
  return findings;
}

std::vector<std::string> keys_of(const nlohmann::json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(FindingsFile, HoldsWhatProgramsAreToldToExpect) {
  const auto json = nlohmann::json::parse(findings_json(some_findings()));
  EXPECT_THAT(keys_of(json), testing::UnorderedElementsAre("crisp", "findings", "unnamed", "unobservable",
                                                           "devices", "indistinguishable"));
  const auto& finding = json["findings"][0];
  EXPECT_THAT(keys_of(finding),
              testing::UnorderedElementsAre("cause", "scope", "parameters", "explained_fraction",
                                            "log10_odds", "p_value", "confounded_with", "gain", "accepted"));
  EXPECT_THAT(keys_of(finding["parameters"][0]),
              testing::UnorderedElementsAre("name", "value", "unit", "std_error"));
  EXPECT_THAT(keys_of(finding["gain"][0]),
              testing::UnorderedElementsAre("metric", "unit", "before", "after", "ci95"));
  EXPECT_EQ(finding["gain"][0]["ci95"][1], -1e-4);
  EXPECT_EQ(json["unnamed"][0]["covariate"], "mirror angle");
  EXPECT_EQ(json["unobservable"][0]["cause"], "encoder.backlash");
  EXPECT_EQ(json["devices"][0]["skew"], 7e-6);
  EXPECT_EQ(json["indistinguishable"]["before_p"], 0.005);
}

TEST(FindingsFile, HoldsWhatSeveralDiagnosesSay) {
  Findings all = some_findings();
  all.append(some_findings());
  all.append({.before_p = 0.5, .after_p = 0.1});
  const auto json = nlohmann::json::parse(findings_json(all));
  for (const char* list : {"findings", "unnamed", "unobservable", "devices"}) {
    EXPECT_EQ(json[list].size(), 2U) << list;
  }
  EXPECT_EQ(json["indistinguishable"]["before_p"], 0.005) << "the smallest";
  EXPECT_EQ(json["indistinguishable"]["after_p"], 0.1);
}

TEST(FindingsFile, IsDocumentedKeyByKey) {
  std::ifstream page(CRISP_SOURCE_DIR "/docs/diagnosis.md");
  std::ostringstream text;
  text << page.rdbuf();
  const auto json = nlohmann::json::parse(findings_json(some_findings()));
  std::vector<nlohmann::json> objects = {json,
                                         json["findings"][0],
                                         json["findings"][0]["parameters"][0],
                                         json["findings"][0]["gain"][0],
                                         json["unnamed"][0],
                                         json["unobservable"][0],
                                         json["devices"][0],
                                         json["indistinguishable"]};
  for (const auto& object : objects) {
    for (const auto& key : keys_of(object)) {
      EXPECT_THAT(text.str(), testing::HasSubstr("`" + key + "`"));
    }
  }
}

}  // namespace
}  // namespace crisp
