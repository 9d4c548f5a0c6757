// SPDX-License-Identifier: BSD-3-Clause
// Findings of a scanner are injected into a simulated one, and found again.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "pipeline/data/degree.hpp"
#include "pipeline/files/findings_file.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::data;
using namespace crisp::files;

const Parameter& parameter_of(const Findings& findings, const std::string& cause, const std::string& name) {
  for (const Finding& finding : findings.findings) {
    if (finding.cause != cause) continue;
    for (const Parameter& parameter : finding.parameters) {
      if (parameter.name == name) return parameter;
    }
  }
  throw std::runtime_error("no " + name + " of " + cause + " was found");
}

double sigma_of(const Findings& findings, const std::string& laser) {
  for (const NoiseFacts& facts : findings.noise) {
    if (facts.laser == laser) return facts.sigma;
  }
  return std::nan("");
}

/// A scanner that stands still is simulated by a pipeline, and diagnosed into the folder `output`.
Findings diagnosed(const test::PipelineFixture& fixture, const std::string& config,
                   const std::filesystem::path& input, const std::string& output,
                   std::vector<std::string> options) {
  // The test's options come later, and take precedence.
  options.insert(options.begin(),
                 {"duration=4s", "motion.kind=constant", "motion.max_rate=0Hz", "lasers.last_angle=45deg"});
  for (auto& option : options) option.insert(0, "grabber.simulate.");
  const auto simulated = fixture.run(config, input, "made", options);
  EXPECT_EQ(simulated.status, ExitStatus::done) << simulated.console;
  const auto outcome = fixture.run("real/sick.yaml", fixture / "made/hub.pcap", output, {},
                                   source_dir() + "/configs/rig.yaml");
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  return read_findings(fixture / (output + "/diagnosis.json"));
}

TEST(Findings, OfOneScannerAreThoseOfTheOneThatIsSimulatedWithThem) {
  const test::PipelineFixture fixture;
  const Findings first = diagnosed(
      fixture, "simulate.yaml", {}, "first",
      {"lasers.mirror_wander=0",
       "effects={laser2.noise.two_peaks: {separation: 15mm}, laser2.noise.normal: {sigma: 5mm}, laser1.range.step: {h: -8mm, at: 1.5s}, laser3.mirror.period: {excess: 0.1ms}}"});
  const Findings again = diagnosed(fixture, "like_real.yaml", fixture / "first", "again", {"seed=77"});
  const auto expect_near = [&](const char* cause, const char* name, double truth) {
    const Parameter& before = parameter_of(first, cause, name);
    const Parameter& after = parameter_of(again, cause, name);
    EXPECT_NEAR(before.value, truth, 4 * before.std_error) << cause;
    EXPECT_NEAR(after.value, before.value, 4 * std::hypot(before.std_error, after.std_error)) << cause;
  };
  expect_near("noise.two_peaks", "separation", 15e-3);
  expect_near("range.step", "h", -8e-3);
  // 36 000 ranges determine a normal distribution's spread to 0.4 %; next to two peaks less well.
  EXPECT_NEAR(sigma_of(again, "laser1"), 12e-3, 0.02 * 12e-3);
  EXPECT_NEAR(sigma_of(again, "laser2"), 5e-3, 0.04 * 5e-3);
  ASSERT_EQ(again.devices.size(), first.devices.size());
  for (std::size_t k = 0; k < first.devices.size(); ++k) {
    EXPECT_EQ(std::isnan(first.devices[k].period), first.devices[k].device == "plate") << "it has no mirror";
    if (std::isnan(first.devices[k].period)) continue;
    // Stamps of 1 us over 4 s; without wander the mean period of any time is that of all.
    EXPECT_NEAR(again.devices[k].period, first.devices[k].period, 1e-6) << first.devices[k].device;
  }
}

const DeviceFacts& device_of(const Findings& findings, const std::string& device) {
  for (const DeviceFacts& facts : findings.devices) {
    if (facts.device == device) return facts;
  }
  throw std::runtime_error("nothing is known of " + device);
}

TEST(Findings, OfSimulatedRealDevicesAreThoseOfTheirFiles) {
  const test::PipelineFixture fixture;
  const Findings found =
      diagnosed(fixture, "simulate.yaml", {}, "out", {"devices=[lms111, laser2=tim781s, laser3=lms511]"});
  const Parameter& separation = parameter_of(found, "noise.two_peaks", "separation");
  EXPECT_NEAR(separation.value, 14.2e-3, 4 * separation.std_error);
  // 36 000 ranges determine a normal distribution's spread to 0.4 %; next to two peaks, or tails, less well.
  EXPECT_NEAR(sigma_of(found, "laser1"), 5.3e-3, 0.04 * 5.3e-3);
  EXPECT_NEAR(sigma_of(found, "laser2"), 11.1e-3, 0.03 * 11.1e-3);
  EXPECT_NEAR(sigma_of(found, "laser3"), 3.9e-3, 0.03 * 3.9e-3);
  const auto expect_device = [&](const char* name, double excess, double wander, double skew, double median) {
    const DeviceFacts& facts = device_of(found, name);
    EXPECT_NEAR(facts.period - facts.nominal_period, excess, 2 * wander * facts.nominal_period) << name;
    EXPECT_NEAR(facts.skew, skew, 4 * facts.skew_std_error) << name;
    EXPECT_NEAR(facts.delay_median, median, 0.3 * median) << name << ": 200 stamps determine it to a tenth";
  };
  expect_device("laser1", 115e-6, 1.1e-3, 7e-6, 68e-6);
  expect_device("laser2", 0, 0.2e-3, 4.1e-6, 182e-6);
  expect_device("laser3", 0, 0.7e-3, 20e-6, 53e-6);
}

TEST(Findings, OfAPlateBehindARadioLinkAreThoseOfItsFile) {
  const test::PipelineFixture fixture;
  const Findings found =
      diagnosed(fixture, "simulate.yaml", {}, "out",
                {"devices=plate=esp32_wifi", "encoder.frequency=4Hz", "duration=200s", "lasers.step=5deg",
                 "lasers.mirror_frequency=5Hz", "links.laser.stall_rate=0Hz", "links.plate.stall_rate=0Hz"});
  const DeviceFacts& plate = device_of(found, "plate");
  EXPECT_NEAR(plate.skew, -117e-6, 4 * plate.skew_std_error);
  // 800 stamps determine the median of such a distribution to 6 %, the 95th percentile to 8 %.
  EXPECT_NEAR(plate.delay_median, 31e-3, 3 * 0.06 * 31e-3);
  EXPECT_NEAR(plate.delay_95, 167e-3, 3 * 0.08 * 167e-3);
}

TEST(Findings, OfScansThemselvesAreThoseThatWereSimulated) {
  const test::PipelineFixture fixture;
  std::ofstream(fixture / "scans.yaml") << "crisp: 1\n"
                                           "pipeline:\n"
                                           "  - stage: grabber.capture\n"
                                           "    with: {file: '${input}'}\n"
                                           "  - stage: diagnose.stationary\n"
                                           "  - stage: clock.convex_hull\n"
                                           "  - stage: diagnose.sweep\n"
                                           "  - stage: write.findings\n"
                                           "    with: {file: '${output}/diagnosis.json'}\n";
  fixture.simulate(
      "made",
      {"duration=20s", "motion.kind=stop_and_go", "motion.max_rate=0.1Hz",
       "effects={laser1.mirror.interleave: {shift: 0.25deg, period: 2, kind: 1}, laser2.latency.bursts: {together: 0.5, interval: 20ms, wait: 60ms}}"});
  const auto outcome = fixture.run(fixture / "scans.yaml", fixture / "made/hub.pcap", "out", {},
                                   source_dir() + "/configs/rig.yaml");
  ASSERT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  const Findings findings = read_findings(fixture / "out/diagnosis.json");
  std::vector<std::string> named;
  for (const Finding& finding : findings.findings) named.push_back(finding.cause + " of " + finding.scope);
  EXPECT_THAT(named,
              testing::UnorderedElementsAre("mirror.interleave of laser1", "latency.bursts of laser2"));
  const Parameter& shift = parameter_of(findings, "mirror.interleave", "shift");
  EXPECT_NEAR(std::abs(shift.value), 0.25 * kDegree, 4 * shift.std_error);
  // About 160 stalls in 20 s determine their share and their length to a tenth.
  EXPECT_NEAR(parameter_of(findings, "latency.bursts", "together").value, 0.5, 4 * 0.05);
  EXPECT_NEAR(parameter_of(findings, "latency.bursts", "wait").value, 0.06, 4 * 0.006);
  EXPECT_LT(findings.before_p, 0.01);
  EXPECT_GT(findings.after_p, 0.01) << "with both the simulated scans are those of the simulation";
}

TEST(Findings, OfStationaryLasersNameWeakEchoesButNoUnknownIncidence) {
  const test::PipelineFixture fixture;
  const Findings found = diagnosed(
      fixture, "simulate.yaml", {}, "out",
      {"effects={laser1.noise.incidence_dependent: {spread: 8mm}, laser2.noise.remission_dependent: {jitter: 80mm}}"});
  const Parameter& jitter = parameter_of(found, "noise.remission_dependent", "jitter");
  EXPECT_NEAR(jitter.value, 80e-3, 4 * jitter.std_error);
  for (const Finding& finding : found.findings) {
    EXPECT_TRUE(finding.scope == "laser2" || !finding.cause.starts_with("noise."))
        << finding.cause << " of " << finding.scope;
  }
  ASSERT_EQ(found.unnamed.size(), 1U);
  EXPECT_EQ(found.unnamed[0].scope, "laser1");
  EXPECT_EQ(found.unnamed[0].covariate, "beam") << "each meets its surface at an angle of its own";
  EXPECT_LT(found.before_p, 1e-6);
  EXPECT_LT(found.after_p, 1e-6) << "what has no name is not simulated";
  for (const ResidualDeparture& departure : found.departures) {
    if (departure.p_value_after > 0.01) continue;
    EXPECT_EQ(departure.scope, "laser1") << departure.quantity << " over the " << departure.covariate;
    EXPECT_NE(departure.quantity, "range");
  }
}

}  // namespace
}  // namespace crisp
