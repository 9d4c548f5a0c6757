// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/catalogue.hpp"

#include <gmock/gmock.h>

#include "pipeline/data/error.hpp"
#include "tests/pipeline/model/terms_support.hpp"

namespace crisp {
namespace {

TEST(Catalogue, HasEveryNameThatReportsAndProgramsUse) {
  std::vector<std::string> names;
  for (const auto& effect : effect_catalogue(built_in_terms())) {
    if (!effect.name.starts_with("empirical.")) names.push_back(effect.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"base.motion",
                                             "clock.drift",
                                             "clock.step",
                                             "encoder.backlash",
                                             "encoder.eccentricity",
                                             "encoder.second_harmonic",
                                             "encoder.speed_lag",
                                             "latency.jitter",
                                             "latency.step",
                                             "mirror.cone",
                                             "mirror.eccentricity",
                                             "mirror.period",
                                             "mount.axial_offset",
                                             "mount.mirror_zero",
                                             "mount.scan_plane_tilt",
                                             "mount.tangential_offset",
                                             "noise.heavy_tail",
                                             "noise.mixed_pixels",
                                             "noise.normal",
                                             "noise.quantisation",
                                             "noise.range_dependent",
                                             "noise.two_peaks",
                                             "plate.rocking",
                                             "plate.wobble",
                                             "range.cyclic",
                                             "range.incidence",
                                             "range.intensity",
                                             "range.offset",
                                             "range.scale",
                                             "range.step",
                                             "range.warmup",
                                             "scene.moving",
                                             "timing.intra_scan"}));
}

TEST(Catalogue, KeepsShapesApartFromCauses) {
  for (const auto& name : built_in_terms().names()) {
    EXPECT_EQ(name.starts_with("empirical."), !built_in_terms().get(name)->info().covariate.empty()) << name;
  }
}

TEST(Catalogue, SaysAllOfTheEffectsBeyondTheChain) {
  for (const auto& effect : effects_beyond_the_chain()) {
    EXPECT_FALSE(effect.summary.empty()) << effect.name;
    EXPECT_FALSE(effect.details.empty()) << effect.name;
    for (const auto& p : effect.parameters) {
      EXPECT_LE(p.lower, p.neutral) << effect.name << "." << p.name;
      EXPECT_GT(p.upper, p.neutral) << effect.name << "." << p.name;
      EXPECT_FALSE(p.summary.empty()) << effect.name << "." << p.name;
    }
  }
}

TEST(TermRegistry, SuggestsTheNearestName) {
  try {
    built_in_terms().get("encoder.excentricity");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'encoder.eccentricity'?"));
  }
}

}  // namespace
}  // namespace crisp
