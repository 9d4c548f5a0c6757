// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/effects.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "grabbers/simulate/device_effects.hpp"
#include "grabbers/simulate/nominal_errors.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;
using testing::HasSubstr;

/// `{name: {parameter: value}}`, as if it stood in line 7 of a file.
OptionGroups one(const std::string& name, const std::vector<std::pair<std::string, std::string>>& values) {
  OptionGroup group{.name = name, .entries = {}, .place = {"x.yaml", 7, 3}};
  for (const auto& [parameter, value] : values) {
    group.entries.push_back({.name = parameter, .value = value, .place = {"x.yaml", 7, 20}});
  }
  return {group};
}

class Effects : public testing::Test {
 protected:
  Effects() { register_built_in(terms_); }

  std::vector<Effect> read(const OptionGroups& requested) {
    return read_effects(requested, rig_, recording_catalogue(terms_));
  }
  std::string complaint(const OptionGroups& requested) {
    try {
      read(requested);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }
  Calibration truth_with(const OptionGroups& requested) {
    Calibration truth = nominal_calibration(rig_);
    add_terms(truth, read(requested), terms_);
    return truth;
  }
  RecordingSettings settings_with(const OptionGroups& requested) {
    RecordingSettings settings;
    EXPECT_TRUE(apply_device_effects(read(requested), settings).empty());
    return settings;
  }

  TermRegistry terms_;
  Rig rig_ = default_rig();
};

TEST_F(Effects, PutATermIntoOneLaserOrIntoAll) {
  const Calibration of_one = truth_with(one("laser2.mirror.cone", {{"kappa", "0.3deg"}}));
  EXPECT_TRUE(of_one.lasers[0].terms.empty());
  ASSERT_EQ(of_one.lasers[1].terms.size(), 1U);
  EXPECT_EQ(of_one.lasers[1].terms[0].term, "mirror.cone");
  EXPECT_NEAR(of_one.lasers[1].terms[0].parameters[0].value, 0.3 * kDegree, 1e-15);
  const Calibration of_all = truth_with(one("mirror.cone", {{"kappa", "0.01"}}));
  for (const auto& laser : of_all.lasers) EXPECT_EQ(laser.terms.at(0).parameters[0].value, 0.01);
}

TEST_F(Effects, OfThePlateMayNameItOrNot) {
  for (const char* name : {"plate.wobble", "plate.plate.wobble"}) {
    const Calibration truth = truth_with(one(name, {{"a", "0.1deg"}, {"d", "0.2deg"}}));
    ASSERT_EQ(truth.plate_terms.size(), 1U);
    EXPECT_NEAR(truth.plate_terms[0].parameters[0].value, 0.1 * kDegree, 1e-15);
    EXPECT_EQ(truth.plate_terms[0].parameters[1].value, 0) << "not given: neutral";
    EXPECT_NEAR(truth.plate_terms[0].parameters[3].value, 0.2 * kDegree, 1e-15);
  }
}

TEST_F(Effects, OfAllLasersAreRefinedByThoseOfOne) {
  OptionGroups requested = one("range.cyclic", {{"a", "3mm"}, {"P", "0.5m"}});
  requested.push_back(one("laser3.range.cyclic", {{"P", "0.7m"}}).front());
  const Calibration truth = truth_with(requested);
  EXPECT_EQ(truth.lasers[1].terms.at(0).parameters[2].value, 0.5);
  EXPECT_EQ(truth.lasers[2].terms.at(0).parameters[0].value, 3e-3);
  EXPECT_EQ(truth.lasers[2].terms.at(0).parameters[2].value, 0.7);
}

TEST_F(Effects, OfNoiseAndMirrorsAffectLasers) {
  const auto of_one = settings_with(one("laser2.noise.heavy_tail", {{"share", "1%"}, {"scale", "10"}}));
  EXPECT_EQ(of_one.scanner.laser_effects.at(0).noise.tail_share, 0);
  EXPECT_NEAR(of_one.scanner.laser_effects.at(1).noise.tail_share, 0.01, 1e-15);
  EXPECT_EQ(of_one.scanner.laser_effects.at(1).noise.tail_scale, 10);
  const auto of_all = settings_with(one("mirror.period", {{"excess", "114us"}}));
  for (const auto& laser : of_all.scanner.laser_effects) EXPECT_NEAR(laser.mirror_excess, 114e-6, 1e-15);
}

TEST_F(Effects, OfClocksAndLinksAffectThePlateToo) {
  const auto settings = settings_with(one("plate.clock.step", {{"by", "2ms"}, {"at", "3s"}}));
  EXPECT_EQ(settings.device_effects.at(0).clock.by, 0);
  EXPECT_EQ(settings.device_effects.at(3).clock.by, 2e-3);
  EXPECT_EQ(settings.device_effects.at(3).clock.at, 3);
  const auto drifting = draw_devices(settings_with(one("clock.drift", {{"drift", "1e-6"}})));
  EXPECT_EQ(drifting.plate.clock.drift, 1e-6);
  EXPECT_EQ(drifting.lasers[2].clock.drift, 1e-6);
  const auto late = draw_devices(settings_with(one("laser1.latency.step", {{"by", "4ms"}, {"at", "1s"}})));
  EXPECT_EQ(late.lasers[0].latency.by, 4e-3);
  EXPECT_EQ(late.lasers[1].latency.by, 0);
}

TEST_F(Effects, OfDevicesThatAreNotNeutralAreListed) {
  std::map<std::string, double> listed;
  for_each_device_effect(
      settings_with(one("laser2.noise.two_peaks", {{"separation", "15mm"}, {"least", "0.2"}})),
      [&](const std::string& name, double value) { listed[name] = value; });
  EXPECT_EQ(listed, (std::map<std::string, double>{{"laser2.noise.two_peaks.separation", 0.015}}));
}

TEST_F(Effects, BeyondTheChainCanAllBeSimulated) {
  for (const auto& effect : effects_beyond_the_chain()) {
    for (const auto& parameter : effect.parameters) {
      const double value = parameter.neutral + (parameter.upper - parameter.neutral) / 4;
      std::size_t listed = 0;
      for_each_device_effect(settings_with(one(effect.name, {{parameter.name, std::to_string(value)}})),
                             [&](const std::string&, double) { ++listed; });
      EXPECT_GE(listed, 3U) << effect.name << "." << parameter.name;
    }
  }
}

TEST_F(Effects, NameUnknownWordsWithTheirPlace) {
  EXPECT_THAT(complaint(one("mirror.coin", {})), HasSubstr("x.yaml:7:3"));
  EXPECT_THAT(complaint(one("mirror.coin", {})), HasSubstr("did you mean 'mirror.cone'?"));
  EXPECT_THAT(complaint(one("laser2.mirror.coin", {})), HasSubstr("did you mean 'mirror.cone'?"));
  EXPECT_THAT(complaint(one("laser9.mirror.cone", {})), HasSubstr("the rig has no 'laser9'; did you mean"));
  EXPECT_THAT(complaint(one("sick.mirror.cone", {})),
              HasSubstr("sick.mirror.cone: the rig has no 'sick'; it has laser1, laser2, laser3, plate"));
  EXPECT_THAT(complaint(one("mirror.cone", {{"kapa", "1deg"}})), HasSubstr("it has kappa"));
  EXPECT_THAT(complaint(one("mirror.cone", {{"kappa", "3mm"}})), HasSubstr("x.yaml:7:20"));
  EXPECT_THAT(complaint(one("mirror.cone", {{"kappa", "3mm"}})), HasSubstr("mirror.cone.kappa: '3mm'"));
  EXPECT_THAT(complaint(one("noise.heavy_tail", {{"share", "120%"}})), HasSubstr("may be from 0 to 1"));
}

TEST_F(Effects, NameOwnersThatCannotHaveThem) {
  EXPECT_THAT(complaint(one("laser1.plate.wobble", {})), HasSubstr("the plate's, not one laser's"));
  EXPECT_THAT(complaint(one("plate.mirror.cone", {})), HasSubstr("each laser's, not the plate's"));
  EXPECT_THAT(complaint(one("laser1.scene.moving", {})), HasSubstr("the scene's"));
  EXPECT_EQ(complaint(one("plate.clock.drift", {})), "nothing");
  EXPECT_THROW(truth_with(one("noise.heavy_tail", {})), Error) << "is no term";
}

TEST_F(Effects, AllMistakesAreReportedAtOnce) {
  OptionGroups requested = one("mirror.coin", {});
  requested.push_back(one("mirror.cone", {{"kapa", "1"}, {"kappa", "1s"}}).front());
  try {
    read(requested);
    FAIL();
  } catch (const ::crisp::Errors& errors) {
    EXPECT_EQ(errors.all().size(), 3U);
  }
}

}  // namespace
}  // namespace crisp
