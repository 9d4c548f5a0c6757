// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include <crisp/calibration_file.hpp>

#include "pipeline/files/calibration_yaml.hpp"
#include "tests/pipeline/files/errors_of.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using testing::ElementsAre;
using testing::HasSubstr;

Calibration parse(const std::string& text) { return parse_calibration(parse_yaml(text, "c.yaml")); }

std::vector<std::string> errors_of_calibration(const std::string& text) {
  return errors_of([&] { parse(text); });
}

/// Written by hand after the format's page.
const char* const kExample = R"(crisp: 1
lasers:
  laser1:
    lambda: {value: 0.0, unit: rad, std_error: 0.0, free: false}
    tau:    {value: 0.19914, unit: m, std_error: 0.00004, free: true}
    alpha:  {value: -0.03561, unit: rad, std_error: 0.00002, free: true}
    eta:    {value: -0.03010, unit: s, std_error: 0.00001, free: true}
    terms:
      mirror.cone: {kappa: {value: 0.0069, unit: rad, std_error: 0.0001, free: true}}
plate:
  terms:
    encoder.eccentricity: {a: {value: 1e-3, unit: rad}, b: {value: -2e-3, unit: rad}}
covariance: {order: [laser1.tau, laser1.alpha], values: [1.6e-9, 1e-12, 1e-12, 4e-10]}
quality:
  rqe: {before: 2.5, after: 1.25}
  points: 1000
  unobservable:
    - {parameter: laser1.eta, reason: "the plate turned at one speed", combination: "eta + lambda / 3.1"}
provenance: {capture: hub.pcap, seed: 7}
)";

TEST(CalibrationFile, ReadsEveryPartOfTheFormat) {
  const Calibration c = parse(kExample);
  ASSERT_EQ(c.lasers.size(), 1u);
  EXPECT_EQ(c.lasers[0].tau.value, 0.19914);
  EXPECT_EQ(c.lasers[0].tau.std_error, 0.00004);
  EXPECT_TRUE(c.lasers[0].tau.free);
  EXPECT_FALSE(c.lasers[0].lambda.free);
  EXPECT_EQ(c.lasers[0].eta.unit, "s");
  ASSERT_EQ(c.lasers[0].terms.size(), 1u);
  EXPECT_EQ(c.lasers[0].terms[0].term, "mirror.cone");
  EXPECT_EQ(c.lasers[0].terms[0].parameters.at(0).name, "kappa");
  EXPECT_EQ(c.plate_terms.at(0).parameters.at(1).value, -2e-3);
  EXPECT_THAT(c.covariance_order, ElementsAre("laser1.tau", "laser1.alpha"));
  EXPECT_THAT(c.covariance, ElementsAre(1.6e-9, 1e-12, 1e-12, 4e-10));
  EXPECT_EQ(c.quality.at("rqe_before"), 2.5);
  EXPECT_EQ(c.quality.at("rqe_after"), 1.25);
  EXPECT_EQ(c.quality.at("points"), 1000);
  ASSERT_EQ(c.unobservable.size(), 1u);
  EXPECT_EQ(c.unobservable[0].combination, "eta + lambda / 3.1");
  EXPECT_EQ(c.provenance.at("seed"), "7");
}

std::string example_with(const std::string& old, const std::string& replacement) {
  std::string text = kExample;
  return text.replace(text.find(old), old.size(), replacement);
}

TEST(CalibrationFile, RefusesSizesThatCannotBeMeant) {
  EXPECT_THAT(errors_of_calibration(example_with("0.19914", "1000")),
              ElementsAre(HasSubstr("c.yaml:5:13: error: laser 'laser1': 'tau': 1000 m is implausible")));
  EXPECT_THAT(errors_of_calibration(example_with("value: 0.0, unit: rad", "value: 1e300, unit: rad")),
              ElementsAre(HasSubstr("'lambda': 1e+300 rad is implausible")));
  EXPECT_THAT(errors_of_calibration(example_with("-0.03010", "20")), ElementsAre(HasSubstr("'eta': 20 s")));
}

TEST(CalibrationFile, NamesThePlaceOfATermsFault) {
  const JudgeTerm judge = [](const TermParameters& term, TermOwner owner) -> std::vector<TermFault> {
    if (owner == TermOwner::plate) return {{"", "no such term", "leave it out"}};
    return {{"kappa", "too many " + term.parameters.at(0).unit, "take fewer"}};
  };
  EXPECT_THAT(errors_of([&] { parse_calibration(parse_yaml(kExample, "c.yaml"), judge); }),
              ElementsAre(HasSubstr("c.yaml:9:28: error: laser 'laser1', term 'mirror.cone': too many rad"),
                          HasSubstr("c.yaml:12:5: error: plate, term 'encoder.eccentricity': no such term")));
}

TEST(CalibrationFile, WritesWhatItReads) {
  const std::string written = to_yaml(parse(kExample));
  EXPECT_EQ(to_yaml(parse(written)), written);
  EXPECT_THAT(written, HasSubstr("    tau:    {value: 0.19914, unit: m, std_error: 4e-05, free: true}\n"));
  EXPECT_THAT(written, HasSubstr("  rqe: {before: 2.5, after: 1.25}\n"));
}

TEST(CalibrationFile, KeepsWhyItWasUntrusted) {
  EXPECT_THAT(parse(kExample).caveats, testing::IsEmpty());
  Calibration c = parse(kExample);
  c.caveats = {"laser1.tau: at its bound", "a \"second\" one"};
  const std::string written = to_yaml(c);
  EXPECT_THAT(written, testing::StartsWith("crisp: 1\ncaveats:\n  - \"laser1.tau: at its bound\"\n"));
  EXPECT_EQ(parse(written).caveats, c.caveats);
  EXPECT_THAT(errors_of_calibration(example_with("lasers:", "caveats: many\nlasers:")),
              ElementsAre(HasSubstr("c.yaml:2:10: error: calibration: 'caveats': 'many' is not a list")));
}

TEST(CalibrationFile, KeepsEveryBitOfADouble) {
  std::mt19937_64 random(1);
  Calibration c;
  c.lasers.emplace_back().name = "a";
  std::vector<double> values = {0.1, -0.0, 5e-324, std::numeric_limits<double>::max(), 1.0 / 3};
  while (values.size() < 2000) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  TermParameters term{"t.x", {}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    term.parameters.push_back({.name = "p" + std::to_string(i), .unit = "1", .value = values[i]});
  }
  c.lasers[0].terms.push_back(term);
  const auto back = parse(to_yaml(c)).lasers.at(0).terms.at(0).parameters;
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back[i].value), std::bit_cast<std::uint64_t>(values[i]))
        << values[i];
  }
}

TEST(CalibrationFile, KeepsTextsThatYamlCouldMistake) {
  Calibration c;
  c.lasers.emplace_back().name = "true";
  const std::map<std::string, std::string> texts = {{"a", "no"},       {"b", "1e5"},
                                                    {"c", "x: y # z"}, {"d", "\"quoted\" \\ and\nbroken\t"},
                                                    {"e", ""},         {"f: g", "${x} – ü"}};
  c.provenance = texts;
  const Calibration back = parse(to_yaml(c));
  EXPECT_EQ(back.provenance, texts);
  EXPECT_EQ(back.lasers.at(0).name, "true");
}

TEST(CalibrationFile, ReportsEveryMistakeWithItsPlace) {
  EXPECT_THAT(
      errors_of_calibration("crisp: 1\n"
                            "lasers:\n"
                            "  a:\n"
                            "    lambda: {value: 0, unit: deg}\n"
                            "    tau: {value: 20cm, unit: m}\n"
                            "    alpha: {valu: 0, unit: rad}\n"
                            "    eta: {value: 0, unit: s, std_error: -1, free: yes}\n"
                            "covariance: {order: [a.tau], values: [1, 2]}\n"
                            "qualiti: {}\n"),
      ElementsAre(
          "c.yaml:4:30: error: laser 'a', lambda: 'deg' is not its unit; convert the value to rad",
          "c.yaml:5:18: error: laser 'a', tau: 'value': '20cm' has a unit, but a plain number is expected; give a number without a unit",
          "c.yaml:6:12: error: laser 'a', alpha: 'value' is missing; add value: VALUE",
          "c.yaml:6:13: error: laser 'a', alpha: there is no key 'valu'; did you mean 'value'?",
          "c.yaml:7:51: error: laser 'a', eta: 'free': 'yes' is neither true nor false; expected is true or false",
          "c.yaml:7:41: error: laser 'a', eta: the standard error is -1; give 0 or more",
          "c.yaml:8:38: error: covariance: there are 2 values for 1 parameters; write 1 x 1, row by row",
          "c.yaml:9:1: error: calibration: there is no key 'qualiti'; did you mean 'quality'?"));
}

TEST(CalibrationFile, RefusesALaterSchemaAndNamesBothVersions) {
  EXPECT_THAT(
      errors_of_calibration("crisp: 3\nlasers: {}\n"),
      testing::Contains(
          "c.yaml:1:8: error: calibration: it has schema version 3, and this program reads up to version 1; use a newer crisp"));
}

TEST(CalibrationFile, DoesNotWriteUnreadableValues) {
  Calibration c;
  c.lasers.emplace_back().name = "a";
  c.lasers[0].tau.value = std::nan("");
  EXPECT_THROW(to_yaml(c), Error);
  c.lasers[0].tau.value = 0;
  c.covariance_order = {"a.tau"};
  EXPECT_THROW(to_yaml(c), Error);
}

TEST(CalibrationFile, ReportsThatARigOrAPipelineIsNone) {
  const auto complaint = [](const std::string& file) -> std::string {
    try {
      read_calibration(source_dir() + "/configs/" + file);
    } catch (const Error& error) {
      return error.message();
    }
    return "nothing";
  };
  EXPECT_THAT(complaint("rig.yaml"), HasSubstr("rig.yaml is a rig, not a calibration"));
  EXPECT_THAT(complaint("assemble.yaml"), HasSubstr("assemble.yaml is a pipeline, not a calibration"));
}

}  // namespace
}  // namespace crisp
