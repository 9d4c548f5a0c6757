// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include <crisp/effect_catalogue.hpp>
#include <crisp/error.hpp>

#include "tests/pipeline/model/terms_support.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

TEST(Catalogue, HasEveryNameThatReportsAndProgramsUse) {
  std::vector<std::string> names;
  for (const auto& effect : effect_catalogue(built_in_terms())) {
    if (!effect.name.starts_with("empirical.")) names.push_back(effect.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"base.motion",
                                             "base.tilt",
                                             "clock.drift",
                                             "clock.skew",
                                             "clock.step",
                                             "encoder.backlash",
                                             "encoder.eccentricity",
                                             "encoder.second_harmonic",
                                             "encoder.slip",
                                             "encoder.speed_lag",
                                             "latency.bursts",
                                             "latency.jitter",
                                             "latency.step",
                                             "mirror.cone",
                                             "mirror.eccentricity",
                                             "mirror.interleave",
                                             "mirror.period",
                                             "mirror.wander",
                                             "mount.axial_offset",
                                             "mount.mirror_zero",
                                             "mount.scan_plane_tilt",
                                             "mount.tangential_offset",
                                             "noise.heavy_tail",
                                             "noise.incidence_dependent",
                                             "noise.mixed_pixels",
                                             "noise.normal",
                                             "noise.quantisation",
                                             "noise.range_dependent",
                                             "noise.remission_dependent",
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

/// Names of families that the catalogue has: "mirror".
std::set<std::string> families() {
  std::set<std::string> all;
  for (const auto& effect : effect_catalogue(built_in_terms())) {
    all.insert(effect.name.substr(0, effect.name.find('.')));
  }
  return all;
}

/// What a source writes in quotes that is named as effects are: "mirror.interleave".
std::set<std::string> names_in(const std::filesystem::path& source) {
  std::ifstream stream(source);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  static const std::regex kName("\"([a-z]+)\\.([a-z_]+)\"");
  const std::set<std::string> known = families();
  std::set<std::string> names;
  for (std::sregex_iterator match(text.begin(), text.end(), kName), end; match != end; ++match) {
    if (known.contains((*match)[1])) names.insert((*match)[1].str() + "." + (*match)[2].str());
  }
  return names;
}

TEST(Catalogue, HasEveryCauseThatAStageCanName) {
  std::set<std::string> catalogue;
  for (const auto& effect : effect_catalogue(built_in_terms())) catalogue.insert(effect.name);
  std::set<std::string> named;
  const auto folder = std::filesystem::path(source_dir()) / "plugins/diagnose";
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
    if (file.is_regular_file()) named.merge(names_in(file.path()));
  }
  for (const char* some : {"scene.moving", "mirror.interleave", "range.warmup", "noise.two_peaks"}) {
    EXPECT_TRUE(named.contains(some)) << some << ": the sources are not read as they are written";
  }
  for (const std::string& name : named) EXPECT_TRUE(catalogue.contains(name)) << name;
}

TEST(Catalogue, KeepsShapesApartFromCauses) {
  for (const auto& name : built_in_terms().names()) {
    EXPECT_EQ(name.starts_with("empirical."), !built_in_terms().get(name)->info().covariate.empty()) << name;
  }
}

TEST(Catalogue, ReportsAllOfTheEffectsBeyondTheChain) {
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
