// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/single_beam_refusal.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>
#include <crisp/rig.hpp>

namespace crisp {
namespace {

using namespace crisp::calibrate;
using testing::HasSubstr;

/// A beam of each laser at each of these mirror angles [rad].
Measurements beams_at(const std::vector<std::vector<float>>& angles) {
  Measurements beams;
  for (std::size_t laser = 0; laser < angles.size(); ++laser) {
    for (const float angle : angles[laser]) {
      beams.range.push_back(3);
      beams.mirror_angle.push_back(angle);
      beams.time.push_back(0.02 * static_cast<double>(beams.range.size()));
      beams.laser.push_back(static_cast<std::uint16_t>(laser));
      beams.remission.push_back(0);
      beams.beam.push_back(0);
    }
  }
  return beams;
}

std::string refusal(const Measurements& beams, const std::vector<std::string>& fixed = {}) {
  try {
    refuse_single_beams(beams, nominal_calibration(default_rig()), fixed);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(SingleBeams, AreRefusedWithTheLasersThatHaveThem) {
  const std::string text = refusal(beams_at({{0.5F, 0.5F, 0.5F}, {-1.5F, 1.5F}, {0, 0}}));
  EXPECT_THAT(
      text,
      HasSubstr(
          "all beams of laser1 (3 beams at 28.648 deg), laser3 (2 beams at 0.000 deg) have the same mirror angle"));
  EXPECT_THAT(text, HasSubstr("fixed: [alpha, tau]"));
}

TEST(SingleBeams, AreTakenWhereAlphaIsNotEstimated) {
  const auto beams = beams_at({{0.5F, 0.5F}, {-1.5F, 1.5F}, {0, 0}});
  EXPECT_EQ(refusal(beams, {"tau", "alpha"}), "");
  EXPECT_EQ(refusal(beams, {"laser1.alpha", "laser3.alpha"}), "");
  EXPECT_THAT(refusal(beams, {"laser1.alpha"}), HasSubstr("of laser3 ("));
}

TEST(SingleBeams, ALaserWithoutBeamsIsNone) { EXPECT_EQ(refusal(beams_at({{0, 1}, {}, {0, 1}})), ""); }

}  // namespace
}  // namespace crisp
