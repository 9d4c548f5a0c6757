// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clocks_stage.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include <crisp/scan.hpp>

#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kFirst_ns = 1'747'663'389'412'884'322;

/// Scan k of a laser that sends four per second, up to 9.6 ms late.
Scan scan_at(int k) {
  Scan scan;
  scan.telegram_counter = scan.scan_counter = static_cast<std::uint16_t>(k);
  scan.scan_time_us = scan.transmission_time_us = static_cast<std::uint32_t>(250'000 * k);
  scan.receipt_ns = kFirst_ns + k * 250'000'000LL + ((k * 7919) % 97) * 100'000LL;
  return scan;
}

struct Reported {
  Findings findings;
  StageReport report;
};

/// @param change  modifies a scan
template <class Change>
Reported resolvable_by(int scans, Change change) {
  auto driver = test::StageDriver::of<DiagnoseClocksStage>({});
  driver.run().rig.lasers = {{.name = "a"}};
  for (int k = 0; k < scans; ++k) {
    Scan scan = scan_at(k);
    change(k, scan);
    driver.feed(scan);
  }
  driver.finish();
  return {*driver.given<Findings>().at(0), driver.report()};
}

TEST(DiagnoseClocks, EstimatesNothingFromFewStamps) {
  for (const int scans : {1, 3, 9}) {
    const Reported reported = resolvable_by(scans, [](int, Scan&) {});
    const DeviceFacts& facts = reported.findings.devices.at(0);
    EXPECT_TRUE(std::isnan(facts.skew) && std::isnan(facts.skew_std_error) && std::isnan(facts.delay_95));
    EXPECT_TRUE(std::isnan(facts.period) && std::isnan(facts.wander));
    ASSERT_EQ(reported.findings.unobservable.size(), 2U);
    EXPECT_EQ(reported.findings.unobservable[0].parameter, "a.clock.drift");
    EXPECT_EQ(reported.findings.unobservable[1].parameter, "a.mirror.period");
    for (const auto& line : reported.report.lines) EXPECT_THAT(line, Not(HasSubstr("nan")));
  }
}

TEST(DiagnoseClocks, ReportsAMirrorTimedByCountsAsUnobservable) {
  const Reported reported = resolvable_by(100, [](int, Scan& scan) {
    scan.timed = false;
    scan.scan_frequency = 4;
  });
  const DeviceFacts& facts = reported.findings.devices.at(0);
  EXPECT_TRUE(std::isfinite(facts.skew)) << "by its count";
  EXPECT_TRUE(std::isnan(facts.period) && std::isnan(facts.period_std_error) && std::isnan(facts.wander));
  ASSERT_EQ(reported.findings.unobservable.size(), 1U);
  EXPECT_EQ(reported.findings.unobservable[0].parameter, "a.mirror.period");
  EXPECT_THAT(reported.findings.unobservable[0].reason, HasSubstr("nominal"));
  EXPECT_THAT(reported.report.lines, testing::Each(Not(testing::EndsWith("%"))));
}

TEST(DiagnoseClocks, TrustsAPlausibleClock) {
  const Reported reported = resolvable_by(200, [](int, Scan&) {});
  EXPECT_THAT(reported.report.caveats, IsEmpty());
  EXPECT_THAT(reported.findings.unobservable, IsEmpty());
}

TEST(DiagnoseClocks, HasACaveatAboutOneWrongReceipt) {
  constexpr int kWrong = 20;
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  for (const std::int64_t wrong_ns : {kFirst_ns - kHour_ns, std::int64_t{1'747'663'399}}) {
    const Reported reported = resolvable_by(46, [&](int k, Scan& scan) {
      if (k == kWrong) scan.receipt_ns = wrong_ns;
    });
    EXPECT_THAT(reported.report.caveats,
                ElementsAre(HasSubstr("a: its stamps fit no clock of constant rate")));
    EXPECT_TRUE(std::isfinite(reported.findings.devices.at(0).skew_std_error));
  }
}

TEST(DiagnoseClocks, HasACaveatAboutConstantReceipts) {
  const Reported reported = resolvable_by(46, [&](int, Scan& scan) { scan.receipt_ns = kFirst_ns; });
  EXPECT_THAT(reported.report.caveats, ElementsAre(HasSubstr("no clock of constant rate")));
}

TEST(DiagnoseClocks, ReportsCompetingCausesOfAStepWithBayesFactors) {
  const Reported reported = resolvable_by(1000, [](int k, Scan& scan) {
    if (k >= 400) scan.receipt_ns += 30'000'000;
  });
  ASSERT_EQ(reported.findings.findings.size(), 1U);
  const Finding& finding = reported.findings.findings[0];
  EXPECT_EQ(finding.cause, "latency.step");
  std::vector<std::string> others;
  for (const OtherCause& other : finding.alternatives) {
    others.push_back(other.cause);
    EXPECT_EQ(other.scope, "a");
    EXPECT_GE(other.log10_bayes_factor, finding.log10_bayes_factor)
        << "against the most likely competitor, or none";
  }
  EXPECT_THAT(others, testing::UnorderedElementsAre("clock.drift", "clock.step"));
  EXPECT_GT(finding.log10_bayes_factor, 2);
  EXPECT_THAT(finding.confounded_with, IsEmpty());
}

TEST(DiagnoseClocks, NamesNoDeviationWithoutASize) {
  for (const int scans : {46, 2000}) {
    const Reported reported = resolvable_by(scans, [&](int, Scan& scan) { scan.receipt_ns = kFirst_ns; });
    for (const Finding& finding : reported.findings.findings) {
      for (const Parameter& parameter : finding.parameters) {
        EXPECT_TRUE(std::isfinite(parameter.value) && std::isfinite(parameter.std_error)) << finding.cause;
      }
    }
    EXPECT_FALSE(reported.report.caveats.empty());
  }
}

}  // namespace
}  // namespace crisp
