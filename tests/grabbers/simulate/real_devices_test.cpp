// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/real_devices.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <crisp/error.hpp>

#include "grabbers/simulate/device_effects.hpp"
#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;
using testing::HasSubstr;

class RealDevicesTest : public testing::Test {
 protected:
  RealDevicesTest() { register_built_in(terms_); }
  std::vector<Effect> effects(const std::vector<std::string>& requested) const {
    return effects_of_real_devices(requested, rig_, recording_catalogue(terms_));
  }
  RecordingSettings settings_with(const std::vector<std::string>& requested) const {
    RecordingSettings settings;
    apply_device_effects(effects(requested), settings);
    return settings;
  }
  std::string complaint(const std::vector<std::string>& requested) const {
    try {
      effects(requested);
    } catch (const Errors& errors) {
      return errors.what();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }
  TermRegistry terms_;
  Rig rig_ = default_rig();
};

/// How many habits a file names: lines with two blanks and a map.
std::ptrdiff_t habits_in(const std::filesystem::path& file) {
  std::ifstream text(file);
  std::ptrdiff_t habits = 0;
  for (std::string line; std::getline(text, line);)
    habits += line.starts_with("  ") && line.find('{') != std::string::npos;
  return habits;
}

TEST_F(RealDevicesTest, AreThoseOfTheFilesWithAllTheirHabitsOfEachLaser) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() + "/configs/devices")) {
    files.push_back(entry.path().stem().string());
    const auto of_all = effects({files.back()});
    EXPECT_EQ(std::ssize(of_all), 3 * habits_in(entry.path())) << files.back();
    EXPECT_TRUE(std::ranges::all_of(of_all, &Effect::measured)) << "in place of what would be drawn";
    RecordingSettings settings;
    EXPECT_TRUE(apply_device_effects(of_all, settings).empty())
        << files.back() << ": habits of devices, all of them";
  }
  EXPECT_THAT(real_devices(), testing::UnorderedElementsAreArray(files));
}

TEST_F(RealDevicesTest, AffectEveryLaserOrTheOneThatIsNamed) {
  const RecordingSettings settings = settings_with({"lms111", "laser2=tim781s", "plate=esp32_wifi"});
  EXPECT_DOUBLE_EQ(settings.scanner.laser_effects[0].noise.sigma, 5.3e-3);
  EXPECT_DOUBLE_EQ(settings.scanner.laser_effects[2].noise.separation, 14.2e-3);
  EXPECT_DOUBLE_EQ(settings.scanner.laser_effects[1].noise.sigma, 11.1e-3) << "what comes later goes before";
  EXPECT_DOUBLE_EQ(settings.scanner.laser_effects[1].noise.separation, 0) << "a TiM alone, no mixture";
  EXPECT_DOUBLE_EQ(settings.device_effects[0].skew, 7e-6);
  EXPECT_FALSE(settings.device_effects[0].drawn);
  EXPECT_DOUBLE_EQ(settings.device_effects[3].skew, -117e-6);
  EXPECT_DOUBLE_EQ(settings_with({"lms111"}).device_effects[3].skew, 0) << "the plate is no laser";
}

TEST_F(RealDevicesTest, HaveRangesInTheStepsOfTheirFiles) {
  for (const auto& [device, step] : {std::pair{"vlp16", 2e-3}, std::pair{"lms2xx", 1e-2}}) {
    ScannerSettings settings = settings_with({device}).scanner;
    settings.duration = 0.1;
    const Measurements beams = simulate_measurements(settings, office()).beams;
    ASSERT_GT(beams.size(), 1000U);
    for (const float range : beams.range) {
      EXPECT_NEAR(std::remainder(double{range}, step), 0, 1e-5) << device;  // ranges are floats
    }
  }
}

TEST_F(RealDevicesTest, LeaveOutWhatTheCatalogueLacks) {
  const auto lasers = effects_of_real_devices({"lms111"}, rig_, laser_catalogue(terms_));
  EXPECT_TRUE(std::ranges::none_of(lasers, [](const Effect& e) { return e.name == "latency.jitter"; }));
  EXPECT_TRUE(std::ranges::any_of(lasers, [](const Effect& e) { return e.name == "noise.two_peaks"; }));
}

TEST_F(RealDevicesTest, ThatAreNotKnownOrCannotBeSuchAreRefused) {
  EXPECT_THAT(complaint({"lsm111"}), HasSubstr("did you mean 'lms111'?"));
  EXPECT_THAT(complaint({"laser7=lms111"}), HasSubstr("the rig has no 'laser7'"));
  EXPECT_THAT(complaint({"plate=lms111"}), HasSubstr("noise.normal is each laser's, not the plate's"));
}

}  // namespace
}  // namespace crisp
