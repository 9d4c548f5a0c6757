// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scan_patterns.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include <crisp/error.hpp>

#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

using Values = std::vector<std::pair<std::string, std::string>>;

/// `{laser: {key: value}}`, as if it stood in line 5 of a file.
OptionGroup lasers_entry(const std::string& laser, const Values& values) {
  OptionGroup group{.name = laser, .entries = {}, .place = {"x.yaml", 5, 3}};
  for (const auto& [key, value] : values) group.entries.push_back({key, value, {"x.yaml", 5, 20}});
  return group;
}

const Values kLms511 = {
    {"first_angle", "-5deg"}, {"last_angle", "185deg"}, {"step", "0.25deg"}, {"mirror_frequency", "25Hz"}};

TEST(ScanPatterns, AreThoseOfAllButForTheLasersThatAreNamed) {
  const auto patterns = read_patterns({lasers_entry("laser2", kLms511)}, default_rig(), {});
  ASSERT_EQ(patterns.size(), 3U);
  EXPECT_NEAR(patterns[1].field.first, -5 * kDegree, 1e-12);
  EXPECT_EQ(patterns[1].field.beams(), 761U);
  EXPECT_EQ(patterns[1].frequency, 25);
  EXPECT_EQ(patterns[2].field.beams(), FieldOfView{}.beams());
  EXPECT_THAT(read_patterns({}, default_rig(), {}), IsEmpty());
}

TEST(ScanPatterns, EveryMistakeIsReportedWithItsPlace) {
  const OptionGroups wrong = {lasers_entry("laser9", {{"step", "1deg"}}),
                              lasers_entry("laser1", {{"stepp", "1deg"}, {"step", "1s"}}),
                              lasers_entry("laser2", {{"last_angle", "-90deg"}}),
                              lasers_entry("laser3", {{"mirror_frequency", "0Hz"}})};
  try {
    read_patterns(wrong, default_rig(), {});
    FAIL() << "nothing was wrong";
  } catch (const Errors& errors) {
    ASSERT_EQ(errors.all().size(), 5U);
    EXPECT_THAT(errors.what(),
                AllOf(HasSubstr("no laser 'laser9'"), HasSubstr("did you mean 'step'"),
                      HasSubstr("laser1.step"), HasSubstr("laser2: "), HasSubstr("laser3.mirror_frequency")));
    for (const Error& error : errors.all()) EXPECT_EQ(error.place().line, 5) << error.what();
  }
}

/// A plate with a laser of 270° at 50 Hz and one of 190° at 25 Hz.
TEST(ScanPatterns, EachLaserSendsItsOwnFieldOfViewAtItsOwnRate) {
  RecordingSettings settings;
  settings.scanner.rig.lasers.resize(2);
  settings.scanner.truth = nominal_calibration(settings.scanner.rig);
  settings.scanner.duration = 2;
  settings.scanner.patterns = read_patterns({lasers_entry("laser2", kLms511)}, settings.scanner.rig,
                                            settings.scanner.pattern_of_all());
  const auto recording = simulate_recording(settings, office());
  std::vector<std::size_t> scans(2);
  for (const Scan& scan : recording.scans) {
    ++scans[scan.laser];
    EXPECT_EQ(scan.echoes.at(0).ranges.size(), scan.laser == 0 ? 541U : 761U);
    EXPECT_NEAR(scan.start_angle, (scan.laser == 0 ? -45 : -5) * kDegree, 1e-9);
    EXPECT_NEAR(scan.scan_frequency, scan.laser == 0 ? 50 : 25, 1e-9);
  }
  EXPECT_NEAR(static_cast<double>(scans[0]), 100, 3);
  EXPECT_NEAR(static_cast<double>(scans[1]), 50, 3);
}

TEST(ScanPatterns, ATelegramLeavesAfterItsLastBeamEvenIfThatIsMoreThanATurnFromTheIndex) {
  RecordingSettings settings;
  settings.scanner.rig.lasers.resize(1);
  settings.scanner.truth = nominal_calibration(settings.scanner.rig);
  settings.scanner.duration = 1;
  settings.scanner.field = {.first = 0, .last = 359 * kDegree, .step = 1 * kDegree};
  settings.scanner.mirror = {.frequency = 10, .slowest = 0, .wander = 0};
  settings.clocks.skew = 0;
  const auto recording = simulate_recording(settings, office());
  ASSERT_FALSE(recording.scans.empty());
  const double turned = (359 + 45) / 360.0;  // from the index, at −45°
  for (const Scan& scan : recording.scans) {
    EXPECT_GT(1e-6 * static_cast<double>(scan.transmission_time_us - scan.scan_time_us), turned / 10);
  }
}

}  // namespace
}  // namespace crisp
