// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include <crisp/builtin.hpp>
#include <crisp/calibration_file.hpp>
#include <crisp/pipeline.hpp>

#include "pipeline/files/findings_file.hpp"
#include "pipeline/files/renamed_names.hpp"
#include "pipeline/stage/pipeline_plan.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using namespace crisp::stage;

using Kind = RenamedName::Kind;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// Warnings of a pipeline of one stage, with what is wrong in it apart from these.
struct Checked {
  std::vector<std::string> stages;
  std::vector<std::set<std::string>> options;
  std::vector<std::string> warnings;
  std::vector<Error> errors;
};

Checked check(const std::string& text, const std::vector<std::string>& set = {}) {
  Builtin builtin;
  Checked result;
  const YamlNode root = parse_yaml(text, "old.yaml");
  const auto plan =
      parse_plan(root, {}, {.set = set, .only_validate = true}, builtin.registrar().stages(), result.errors);
  for (const auto& spec : plan.stages) {
    result.stages.push_back(spec.stage);
    std::set<std::string> options;
    for (const auto& [name, place] : spec.places) options.insert(name);
    result.options.push_back(options);
  }
  for (const auto& warning : plan.warnings)
    result.warnings.push_back(to_string(warning.place) + ": " + warning.text);
  return result;
}

TEST(OldNames, AreThoseOfStagesAndOptionsThatExistUnderTheNewName) {
  Builtin builtin;
  const StageRegistry& stages = builtin.registrar().stages();
  for (const RenamedName& one : renamed_names()) {
    if (one.kind == Kind::stage) {
      EXPECT_TRUE(stages.find(std::string(one.name))) << one.name;
      EXPECT_FALSE(stages.find(std::string(one.old_name))) << one.old_name;
    }
    if (one.kind == Kind::option) {
      const StageType* type = stages.find(std::string(one.owner));
      ASSERT_TRUE(type) << one.owner;
      EXPECT_TRUE(type->find_option(std::string(one.name))) << one.owner << "." << one.name;
      EXPECT_FALSE(type->find_option(std::string(one.old_name))) << one.owner << "." << one.old_name;
    }
  }
}

TEST(OldNames, OfStagesAndOptionsAreAcceptedWithAWarningAtTheirPlace) {
  for (const RenamedName& one : renamed_names()) {
    if (one.kind == Kind::key) continue;
    const bool is_stage = one.kind == Kind::stage;
    const std::string stage(is_stage ? one.old_name : one.owner);
    std::string text = "crisp: 1\npipeline:\n  - stage: " + stage + "\n";
    if (!is_stage) text += "    with:\n      " + std::string(one.old_name) + ": 1\n";
    const Checked result = check(text);
    ASSERT_EQ(result.stages.size(), 1U) << text;
    EXPECT_EQ(result.stages[0], is_stage ? one.name : one.owner);
    if (!is_stage) {
      EXPECT_THAT(result.options[0], testing::ElementsAre(std::string(one.name)));
    }
    const std::string place = is_stage ? "old.yaml:3:12: " : "old.yaml:5:7: ";
    EXPECT_THAT(result.warnings,
                testing::ElementsAre(testing::StartsWith(place + "'" + std::string(one.old_name) +
                                                         "' is now called '" + std::string(one.name) + "'")));
  }
}

TEST(OldNames, AreAcceptedInSettingsAndInputsToo) {
  const Checked result = check(
      "crisp: 1\npipeline:\n  - stage: grabber.capture\n    with: {file: a.pcap}\n  - stage: diagnose.passes\n"
      "  - stage: diagnose.stationary\n  - {stage: write.findings, inputs: diagnose.rest, with: {file: a.json}}\n",
      {"diagnose.rest.mend=true"});
  EXPECT_TRUE(result.errors.empty()) << result.errors.front().what();
  EXPECT_THAT(result.options.at(2), testing::ElementsAre("correct"));
  EXPECT_THAT(result.warnings, testing::ElementsAre(testing::HasSubstr("old.yaml:7:37: 'diagnose.rest'"),
                                                    testing::HasSubstr("'diagnose.rest' is now called"),
                                                    testing::HasSubstr("'mend' is now called 'correct'")));
}

TEST(OldNames, OfAGroupsNameAreOptionsOfEarlierReleasesUnlessTheValueIsAMapOfTheGroup) {
  const auto simulate = [](const std::string& options) {
    return check("crisp: 1\npipeline:\n  - stage: grabber.simulate\n    with: {" + options + "}\n");
  };
  const Checked old = simulate("motion: reversal, lasers: {laser2: {step: 1deg}}");
  EXPECT_TRUE(old.errors.empty()) << old.errors.front().what();
  EXPECT_THAT(old.options.at(0), testing::ElementsAre("lasers.kinds", "motion.kind"));
  EXPECT_EQ(old.warnings.size(), 2U);
  const Checked current =
      simulate("motion: {kind: reversal}, lasers: {step: 1deg, kinds: {laser2: {step: 1deg}}}");
  EXPECT_TRUE(current.errors.empty()) << current.errors.front().what();
  EXPECT_THAT(current.options.at(0), testing::ElementsAre("lasers.kinds", "lasers.step", "motion.kind"));
  EXPECT_TRUE(current.warnings.empty());
}

TEST(OldNames, OfACalibrationsKeysAreAcceptedWithAWarning) {
  const test::TemporaryFolder folder;
  Calibration calibration = nominal_calibration(default_rig());
  calibration.caveats = {"views disagree"};
  std::ofstream(folder / "old.yaml") << replaced(to_yaml(calibration), "caveats:", "doubts:");
  std::vector<std::string> warnings;
  const Calibration read = read_calibration(
      folder / "old.yaml", {}, [&](const Error& warning) { warnings.emplace_back(warning.what()); });
  EXPECT_EQ(read.caveats, calibration.caveats);
  EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr("'doubts' is now called 'caveats'")));
}

TEST(OldNames, OfADiagnosisKeysAreAcceptedWithAWarningEach) {
  const test::TemporaryFolder folder;
  Findings findings{.before_p = 0.25, .after_p = 0.5};
  for (const char* cause : {"mirror.cone", "range.offset"}) {
    findings.findings.push_back(
        {.cause = cause, .scope = "laser1", .log10_bayes_factor = 3, .resolvable_by = {"reversals"}});
  }
  findings.artifacts.push_back({.name = "density", .parameters = {}, .reason = "few beams"});
  std::string text = findings_json(findings);
  for (const RenamedName& one : renamed_names()) {
    if (one.kind != Kind::key || one.owner != "diagnosis") continue;
    ASSERT_THAT(text, testing::HasSubstr('"' + std::string(one.name) + '"')) << "a key of the file";
    text = replaced(text, '"' + std::string(one.name) + '"', '"' + std::string(one.old_name) + '"');
  }
  std::ofstream(folder / "old.json") << text;
  std::set<std::string> warnings;
  const Findings read =
      read_findings(folder / "old.json", [&](const Error& warning) { warnings.insert(warning.what()); });
  EXPECT_EQ(findings_json(read), findings_json(findings));
  EXPECT_EQ(warnings.size(), 6U) << "one a name, however often it stands there";
}

TEST(OldNames, OfASummaryAreRenamedAtAnyDepth) {
  nlohmann::json summary = {{"stages", {{{"doubts", {"a"}}}, {{"caveats", {"b"}}}}}};
  rename_old_keys(summary, "summary");
  EXPECT_EQ(summary, nlohmann::json({{"stages", {{{"caveats", {"a"}}}, {{"caveats", {"b"}}}}}}));
}

}  // namespace
}  // namespace crisp
