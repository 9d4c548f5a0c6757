// SPDX-License-Identifier: BSD-3-Clause
// From a capture and the true calibration to a cloud whose every point is as far from the true walls as the
// noise of its range put it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <crisp/calibration_file.hpp>

#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/end_to_end/room.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using test::Outcome;
using test::PipelineFixture;
using test::Residual;

constexpr double kNoise = 0.012;  // [m]
constexpr double kStep = 0.001;   // [m] ranges are rounded to
/// Standard deviation of a range: the noise, and the rounding's even spread.
const double kRangeSigma = std::sqrt(kNoise * kNoise + kStep * kStep / 12);
/// What else moves a point, along the plate's turn: the encoder's steps (2π/16384, evenly spread) and 20 µs
/// between the clocks of plate and laser at 2 Hz, both at 4 m from the axis.
const double kAngleSigma =
    4 * std::hypot(2 * std::numbers::pi / 16384 / std::sqrt(12.0), 20e-6 * 2 * std::numbers::pi * 2);

class Assemble : public testing::Test {
 protected:
  void simulate(std::vector<std::string> options) {
    options.push_back("scene_file=" + test::write_room(fixture_ / "room.yaml").string());
    fixture_.simulate("simulation", options);
    truth_ = read_calibration(fixture_ / "simulation/truth.yaml");
  }

  std::vector<Residual> residuals(const Outcome& outcome) const {
    std::vector<double> tau;
    for (const auto& laser : truth_.lasers) tau.push_back(laser.tau.value);
    return test::against_room(*outcome.cloud, tau);
  }

  PipelineFixture fixture_;
  Calibration truth_;
};

double in_sigmas(const Residual& each) { return each.distance / (kRangeSigma * each.incidence); }

TEST_F(Assemble, PointsAreAsFarFromTheTrueWallsAsTheNoiseOfTheirRangesPutThem) {
  simulate({"duration=3s"});
  const Outcome outcome = fixture_.assemble("simulation", "out");
  ASSERT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  EXPECT_EQ(outcome.console, "");
  EXPECT_EQ(outcome.losses("grabber.capture") + outcome.losses("assemble.deskew"), 0U);
  EXPECT_EQ(outcome.stage("assemble.deskew")["report"]["points"], outcome.cloud->size());

  const auto all = residuals(outcome);
  ASSERT_GT(all.size(), 0.9 * static_cast<double>(outcome.cloud->size()));
  const double sampling = 1 / std::sqrt(2.0 * static_cast<double>(all.size()));
  const double spread = test::rms(all, in_sigmas);
  EXPECT_GT(spread, 1 - 4 * sampling);
  EXPECT_LT(spread, std::hypot(1, kAngleSigma / kRangeSigma) + 4 * sampling);

  for (int wall = 0; wall < 6; ++wall) {
    double sum = 0;
    std::size_t n = 0;
    for (const auto& each : all) {
      if (each.wall != wall) continue;
      sum += each.distance;
      ++n;
    }
    ASSERT_GT(n, 5000U);
    EXPECT_NEAR(sum / static_cast<double>(n), 0,
                4 * kRangeSigma / std::sqrt(static_cast<double>(n)) + kAngleSigma)
        << "wall " << wall;
  }
}

TEST_F(Assemble, TheNominalValuesOfTheRigGiveAFarWorseCloud) {
  simulate({"duration=2s"});
  const Outcome good = fixture_.assemble("simulation", "good");
  write_calibration(fixture_ / "nominal.yaml", nominal_calibration(default_rig()));
  const Outcome bad = fixture_.run("assemble.yaml", fixture_ / "simulation/hub.pcap", "bad",
                                   {"calibration=" + (fixture_ / "nominal.yaml").string()});
  ASSERT_EQ(bad.status, ExitStatus::done) << bad.console;
  EXPECT_EQ(bad.cloud->size(), good.cloud->size());
  EXPECT_GT(test::rms(residuals(bad), in_sigmas), 3 * test::rms(residuals(good), in_sigmas));
}

TEST_F(Assemble, TheSkewsOfTheClocksAreRightWithinOnePpmOverTenMinutes) {
  simulate({"duration=600s", "clocks.drift=1.4e-9", "lasers.first_angle=0deg", "lasers.last_angle=90deg",
            "lasers.step=5deg", "encoder.frequency=100Hz", "telegrams.remission=none"});
  const Outcome outcome = fixture_.assemble("simulation", "out");
  ASSERT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  const auto& devices = outcome.stage("clock.convex_hull")["report"]["devices"];
  ASSERT_EQ(devices.size(), 4U);
  for (const auto& device : devices) {
    const std::string name = device["device"];
    const double skew = std::stod(truth_.provenance.at(name + ".clock.skew"));
    const double drift = std::stod(truth_.provenance.at(name + ".clock.drift"));
    EXPECT_NEAR(device["skew_ppm"], 1e6 * (skew + 300 * drift), 1) << name;
  }
}

}  // namespace
}  // namespace crisp
