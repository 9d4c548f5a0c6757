// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/deskew_stage.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include <crisp/cloud.hpp>
#include <crisp/effect_catalogue.hpp>
#include <crisp/error.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/registrar.hpp>
#include <crisp/runner.hpp>

#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::assemble;
using test::StageDriver;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

/// A plate that turns once a second, read every 2 ms.
PlateTrajectory turning(double begin, double end, double max_gap = 0.01) {
  std::vector<double> times, angles;
  for (double t = begin; t < end + 0.001; t += 0.002) {
    times.push_back(t);
    angles.push_back(2 * kPi * t);
  }
  return {0, times, angles, max_gap};
}

/// Beams of laser 1 at θ = 90°: they stay in the plane z = 0, and with τ = 0 end at azimuth φ + λ + 90°.
Measurements beams_at(std::initializer_list<double> times) {
  Measurements beams;
  for (const double t : times) {
    beams.range.push_back(2);
    beams.mirror_angle.push_back(static_cast<float>(kPi / 2));
    beams.time.push_back(t);
    beams.laser.push_back(0);
    beams.remission.push_back(1);
    beams.beam.push_back(0);
  }
  return beams;
}

Calibration with_lambda(double lambda) {
  Calibration calibration = nominal_calibration(default_rig());
  calibration.lasers[0].lambda.value = lambda;
  calibration.lasers[0].tau.value = 0;
  return calibration;
}

double azimuth(const Point& point) {
  return std::atan2(static_cast<double>(point.y), static_cast<double>(point.x));
}

std::vector<double> times_of(const std::vector<std::shared_ptr<const Cloud>>& clouds) {
  std::vector<double> times;
  for (const auto& cloud : clouds) {
    for (const auto& point : *cloud) times.push_back(point.time);
  }
  return times;
}

class DeskewStageTest : public testing::Test {
 protected:
  DeskewStageTest() {
    registrar_.attach(terms_);
    stage_.run().registrar = &registrar_;
  }

  TermRegistry terms_;
  Registrar registrar_;
  StageDriver stage_ = StageDriver::of<DeskewStage>({});
};

TEST_F(DeskewStageTest, PlacesEachBatchByTheCalibrationThatIsHeldAndThePieceOfTrajectoryThatCoversIt) {
  stage_.feed(beams_at({0.25}), turning(0, 1), with_lambda(0));
  stage_.feed(beams_at({1.25}), turning(1, 2), with_lambda(kPi / 2));
  stage_.finish();
  const auto clouds = stage_.given<Cloud>();
  ASSERT_EQ(clouds.size(), 2U) << "one cloud a batch, so that memory does not grow";
  // A quarter turn: at λ = 0 the beam leaves along −x, at λ = 90° along −y.
  EXPECT_NEAR((clouds[0]->at(0).getVector3fMap() - Eigen::Vector3f(-2, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((clouds[1]->at(0).getVector3fMap() - Eigen::Vector3f(0, -2, 0)).norm(), 0, 1e-6);
  EXPECT_EQ(stage_.report().section["points"], 2);
  EXPECT_EQ(stage_.report().section["calibration"], "given");
  EXPECT_EQ(stage_.report().counts.at("beams outside the encoder readings"), 0U);
  EXPECT_THAT(stage_.report().warnings, IsEmpty());
}

TEST_F(DeskewStageTest, NamesTermsNotAppliedForUnknownIncidence) {
  register_built_in(terms_);
  Calibration calibration = with_lambda(0);
  for (const auto* name : {"range.incidence", "range.offset"}) {
    calibration.lasers[1].terms.push_back(neutral_parameters(terms_.get(name)->info()));
  }
  for (const bool is_known : {true, false}) {
    Measurements beams = beams_at({0.5});
    if (is_known) beams.cos_incidence.assign(beams.size(), 0.5F);
    StageDriver stage = StageDriver::of<DeskewStage>({});
    stage.run().registrar = &registrar_;
    stage.feed(beams, turning(0, 1), calibration);
    stage.finish();
    EXPECT_EQ(stage.report().warnings.size(), is_known ? 0U : 1U);
    if (is_known) continue;
    EXPECT_THAT(stage.report().warnings,
                ElementsAre(HasSubstr("without laser2.range.incidence: the incidence angles")));
  }
}

TEST_F(DeskewStageTest, TakesTheNominalValuesOfTheRigWhereNoCalibrationIsGiven) {
  stage_.run().rig.lasers[0].nominal.lambda.value = kPi / 2;
  stage_.feed(beams_at({0.25}), turning(0, 1));
  stage_.finish();
  const Point& point = stage_.given<Cloud>().at(0)->at(0);
  EXPECT_NEAR((point.getVector3fMap() - Eigen::Vector3f(-0.2F, -2, 0)).norm(), 0, 1e-6) << "τ is 0.2 m";
  EXPECT_EQ(stage_.report().section["calibration"], "nominal");
  EXPECT_THAT(stage_.report().lines, ElementsAre(HasSubstr("the rig's nominal values")));
}

TEST_F(DeskewStageTest, DropsAndCountsBeamsBeforeBehindAndInGapsOfThePlatesReadings) {
  std::vector<double> times, angles;
  for (const double t : {1.0, 1.005, 1.010, 1.110, 1.115, 1.120}) {  // silent for 100 ms
    times.push_back(t);
    angles.push_back(t);
  }
  const PlateTrajectory gap(0, times, angles, 0.05);
  stage_.feed(beams_at({0.999, 1.002, 1.011, 1.109, 1.112, 1.121}), gap, with_lambda(0));
  stage_.finish();
  EXPECT_THAT(times_of(stage_.given<Cloud>()), ElementsAre(1.002, 1.112));
  EXPECT_EQ(stage_.report().counts.at("beams outside the encoder readings"), 4U);
  EXPECT_THAT(stage_.report().warnings, ElementsAre(HasSubstr("66.7 % of the beams are not in the cloud")));
}

TEST_F(DeskewStageTest, ThatNoBeamAtAllCanBePlacedIsAnError) {
  stage_.feed(beams_at({2, 3}), turning(0, 1), with_lambda(0));
  EXPECT_THROW(stage_.finish(), Error);
}

TEST_F(DeskewStageTest, TheLagMovesABeamAcrossTheEdgeOfTheReadings) {
  Calibration late = with_lambda(0);
  late.lasers[0].eta.value = 0.03;
  stage_.feed(beams_at({-0.02, 0.98}), turning(0, 1), late);
  const auto cloud = stage_.given<Cloud>().at(0);
  EXPECT_THAT(times_of({cloud}), ElementsAre(-0.02)) << "φ(t + η) is known for the first and not the second";
  EXPECT_NEAR(azimuth(cloud->at(0)), kPi / 2 + 2 * kPi * 0.01, 1e-6);
}

TEST_F(DeskewStageTest, ACalibrationForFewerLasersThanWereRecordedIsAnError) {
  Calibration short_one = with_lambda(0);
  short_one.lasers.resize(1);
  Measurements beams = beams_at({0.25});
  beams.laser[0] = 2;
  EXPECT_THROW(stage_.feed(beams, turning(0, 1), short_one), Error);
}

/// Two windows as a clock stage gives them: a piece of the plate's trajectory, then its measurements.
class TwoWindows final : public Stage {
 public:
  static void describe(StageDescription<TwoWindows>& d) {
    d.name("test.windows").summary("two windows").gives<PlateTrajectory>().gives<Measurements>();
  }
  void process(const Inputs&, Outputs& out, Context&) override {
    out.give(turning(0, 1));
    out.give(beams_at({0.25}));
    out.give(beams_at({0.5}));
    out.give(turning(1, 2));
    out.give(beams_at({1.75}));
  }
};

/// Calibrates when it has seen everything; adds its step to the λ of the calibration before it.
class LateCalibration final : public Stage {
 public:
  static void describe(StageDescription<LateCalibration>& d) {
    d.name("test.calibrate").summary("gives a calibration at the end");
    d.takes<Measurements>().holds<Calibration>(Need::optional).gives<Calibration>();
    d.option("step", &LateCalibration::step_, "added to lambda").unit("rad");
  }
  void process(const Inputs& in, Outputs&, Context&) override {
    if (const auto* before = in.find<Calibration>()) lambda_ = before->lasers[0].lambda.value;
    ++seen_;
  }
  void finish(Outputs& out, Context&) override { out.give(with_lambda(seen_ == 3 ? lambda_ + step_ : -1)); }

 private:
  double step_ = 0;
  double lambda_ = 0;
  int seen_ = 0;
};

class KeepClouds final : public Stage {
 public:
  static std::vector<std::shared_ptr<const Cloud>>& kept() {
    static std::vector<std::shared_ptr<const Cloud>> clouds;
    return clouds;
  }
  static void describe(StageDescription<KeepClouds>& d) {
    d.name("test.keep").summary("keeps clouds").takes<Cloud>();
  }
  void process(const Inputs& in, Outputs&, Context&) override { kept().push_back(in.share<Cloud>()); }
};

TEST_F(DeskewStageTest, WaitsForTheNearestOfTwoCalibrationsThatComeAtTheEndAndThenPlacesAllWindows) {
  registrar_.stage<TwoWindows>();
  registrar_.stage<LateCalibration>();
  registrar_.stage<DeskewStage>();
  registrar_.stage<KeepClouds>();
  KeepClouds::kept().clear();
  RunSettings run{.registrar = &registrar_};
  Pipeline pipeline =
      build_pipeline({{.stage = "test.windows"},
                      {.stage = "test.calibrate", .tag = "coarse", .with = {{"step", OptionScalar(0.5)}}},
                      {.stage = "test.calibrate", .tag = "fine", .with = {{"step", OptionScalar(0.25)}}},
                      {.stage = "assemble.deskew"},
                      {.stage = "test.keep"}},
                     run);
  run_pipeline(pipeline, run);
  const auto clouds = KeepClouds::kept();
  EXPECT_THAT(times_of(clouds), ElementsAre(0.25, 0.5, 1.75));
  // φ + 90° + λ with λ = 0.5 + 0.25: at a quarter turn, a half, and three quarters of the second one.
  ASSERT_EQ(clouds.size(), 3U);
  EXPECT_NEAR(azimuth(clouds[0]->at(0)), kPi + 0.75 - 2 * kPi, 1e-6);
  EXPECT_NEAR(azimuth(clouds[1]->at(0)), -kPi / 2 + 0.75, 1e-6);
  EXPECT_NEAR(azimuth(clouds[2]->at(0)), 0.75, 1e-6);
}

}  // namespace
}  // namespace crisp
