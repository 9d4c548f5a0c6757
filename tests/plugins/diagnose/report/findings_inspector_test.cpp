// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/findings_inspector.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "pipeline/files/findings_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::files;
using testing::HasSubstr;

Findings some_findings() {
  Findings all;
  all.findings = {{.cause = "mirror.cone",
                   .scope = "laser2",
                   .parameters = {{.name = "kappa", .unit = "rad", .value = 0.005, .std_error = 1e-4}},
                   .p_value = 1e-9,
                   .accepted = true}};
  all.unnamed = {{.covariate = "time", .quantity = "lag", .scope = "laser1", .amplitude = 4e-4, .unit = "m"}};
  all.unobservable = {{.parameter = "encoder.backlash", .reason = "no reversal"}};
  all.noise = {{.laser = "laser1", .ranges = 1000, .sigma = 0.0113}};
  all.before_p = 0.005;
  all.after_p = 0.6;
  return all;
}

TEST(FindingsInspector, SummarizesADiagnosis) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "diagnosis.json", findings_json(some_findings()));
  const Inspection inspection = findings_inspector().inspect(folder / "diagnosis.json", {});
  for (const char* part :
       {"causes: 1, and 0 rejected; unnamed findings: 1;", "not identifiable: encoder.backlash: no reversal",
        "mirror.cone of laser2: kappa = 0.2865", "p = 1e-09", "lag of laser1", "noise 11.30 mm",
        "p = 0.005 before, p = 0.6 after"}) {
    EXPECT_THAT(inspection.text, HasSubstr(part));
  }
  EXPECT_EQ(inspection.data["findings"][0]["cause"], "mirror.cone");
  EXPECT_EQ(inspection.data["unnamed"], 1);
  EXPECT_EQ(inspection.data["after_p"], 0.6);
}

TEST(FindingsInspector, PrintsUnknownNumbersInWords) {
  const test::TemporaryFolder folder;
  Findings all;
  all.devices = {{.device = "laser1", .stamps = 3, .skew = kNotTested, .skew_std_error = kNotTested}};
  test::put_bytes(folder / "diagnosis.json", findings_json(all));
  const Inspection inspection = findings_inspector().inspect(folder / "diagnosis.json", {});
  EXPECT_THAT(inspection.text, HasSubstr("laser1: clock not identifiable from 3 stamps"));
  EXPECT_THAT(inspection.text, testing::Not(HasSubstr("nan")));
}

TEST(FindingsInspector, RecognizesADiagnosisByItsFirstKeys) {
  EXPECT_TRUE(findings_inspector().recognises(findings_json(some_findings())));
  EXPECT_TRUE(findings_inspector().recognises(findings_json({})));
  EXPECT_FALSE(findings_inspector().recognises(R"({"crisp": "0.1.0", "stages": [], "findings": 2})"));
  EXPECT_FALSE(findings_inspector().recognises("crisp: 1\nlasers:\n"));
  EXPECT_FALSE(findings_inspector().recognises(""));
}

TEST(FindingsInspector, RejectsADamagedDiagnosis) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "diagnosis.json", R"({"crisp": 1, "findings": [], "unnamed": 3})");
  EXPECT_THROW(findings_inspector().inspect(folder / "diagnosis.json", {}), Errors);
}

}  // namespace
}  // namespace crisp
