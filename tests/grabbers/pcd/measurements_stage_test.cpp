// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/measurements_stage.hpp"

#include <gmock/gmock.h>

#include <crisp/cloud.hpp>
#include <crisp/cloud_conversion.hpp>

#include "grabbers/pcd/cloud_stage.hpp"
#include "pipeline/pcd/parts.hpp"
#include "plugins/write/measurements_stage.hpp"
#include "tests/pipeline/pcd/sample_tables.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::pcd;
using namespace crisp::pcd_grabber;
using namespace crisp::write;
namespace fs = std::filesystem;
using test::sample_measurements;
using test::sample_plate;
using test::StageDriver;
using testing::HasSubstr;

class GrabMeasurements : public testing::Test {
 protected:
  std::map<std::string, OptionValue> file(std::string_view name) const {
    return {{"file", OptionScalar((folder_ / name).string())}};
  }
  StageDriver written(
      const std::vector<std::pair<Measurements, std::shared_ptr<const PlateTrajectory>>>& items,
      std::map<std::string, OptionValue> options = {}) const {
    options.merge(file("run.pcd"));
    auto stage = StageDriver::of<WriteMeasurementsStage>(options);
    for (const auto& [beams, plate] : items) stage.feed(beams, plate);
    stage.finish();
    return stage;
  }
  StageDriver read() const {
    auto stage = StageDriver::of<GrabMeasurementsStage>(file("run.pcd"));
    stage.feed();
    return stage;
  }
  std::string complaint() const {
    try {
      read();
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
  test::TemporaryFolder folder_;
};

std::shared_ptr<const PlateTrajectory> plate(double seconds) {
  return std::make_shared<const PlateTrajectory>(sample_plate(seconds));
}

Measurements joined(const StageDriver& stage) {
  Measurements all;
  for (const auto& beams : stage.given<Measurements>()) all.append(*beams);
  return all;
}

void expect_same(const Measurements& actual, const Measurements& expected) {
  EXPECT_EQ(actual.epoch_ns, expected.epoch_ns);
  EXPECT_EQ(actual.range, expected.range);
  EXPECT_EQ(actual.mirror_angle, expected.mirror_angle);
  EXPECT_EQ(actual.time, expected.time);
  EXPECT_EQ(actual.laser, expected.laser);
  EXPECT_EQ(actual.remission, expected.remission);
  EXPECT_EQ(actual.beam, expected.beam);
}

TEST_F(GrabMeasurements, GivesExactlyWhatWasWritten) {
  const auto beams = sample_measurements(40000);
  written({{beams, plate(1)}, {beams, plate(1)}});
  const auto stage = read();
  Measurements both = beams;
  both.append(beams);
  expect_same(joined(stage), both);
  const auto last = stage.given<PlateTrajectory>().back();
  ASSERT_EQ(last->size(), sample_plate(1).size());
  EXPECT_EQ(last->at(0.77)->angle, sample_plate(1).at(0.77)->angle);
}

TEST_F(GrabMeasurements, EachPieceOfTheTrajectoryComesBeforeItsMeasurements) {
  const auto beams = sample_measurements(10);
  const auto first = plate(1);
  const auto second = plate(2);
  const auto writer = written({{beams, first}, {beams, first}, {beams, second}});
  EXPECT_EQ(writer.report().written.size(), 4U) << "two parts of two files";
  const auto stage = read();
  const auto plates = stage.given<PlateTrajectory>();
  ASSERT_EQ(plates.size(), 2U);
  EXPECT_EQ(plates[0]->end(), first->end());
  EXPECT_EQ(plates[1]->end(), second->end());
  const auto items = stage.given<Measurements>();
  ASSERT_EQ(items.size(), 2U);
  EXPECT_EQ(items[0]->size(), 20U);
  EXPECT_EQ(items[1]->size(), 10U);
}

TEST_F(GrabMeasurements, ManyMeasurementsAreSplitAndComeBackTheSame) {
  const auto beams = sample_measurements(100);
  written({{beams, plate(1)}, {beams, plate(1)}, {beams, plate(1)}},
          {{"split_points", OptionScalar(std::int64_t{150})}});
  EXPECT_TRUE(fs::exists(folder_ / "run_0003.plate.pcd"));
  Measurements all = beams;
  all.append(beams);
  all.append(beams);
  expect_same(joined(read()), all);
}

TEST_F(GrabMeasurements, WithoutThePlatesFileTheAnglesNextToTheMeasurementsDo) {
  written({{sample_measurements(2000), plate(1)}});
  fs::remove(folder_ / "run.plate.pcd");
  const auto stage = read();
  EXPECT_EQ(stage.report().warnings.size(), 1U);
  const double middle = sample_measurements(2000).time[1000] + 5e-6;
  // Between measurements 18.5 µs apart a cubic is as good as exact.
  EXPECT_NEAR(stage.given<PlateTrajectory>().at(0)->at(middle)->angle, sample_plate(1).at(middle)->angle,
              1e-9);
}

TEST_F(GrabMeasurements, WhatDoesNotBelongTogetherIsRefused) {
  written({{sample_measurements(10), plate(1)}});
  PartsWriter writer(folder_ / "run.plate.pcd", PcdFormat::binary);
  PcdTable table(2);
  table.set_note("epoch_ns", "5");
  table.set_note("max_gap", "1");
  table.add<double>("time", [](std::size_t i) { return static_cast<double>(i); });
  table.add<double>("angle", [](std::size_t i) { return static_cast<double>(i); });
  writer.write(table, false);
  writer.commit();
  EXPECT_THAT(complaint(), HasSubstr("are of different runs"));
}

TEST_F(GrabMeasurements, AnInterruptedRunIsNotedWhereTheEpochsAreTheSame) {
  const auto beams = sample_measurements(10);
  written({{beams, plate(2)}});
  const fs::path old = folder_ / "old.plate.pcd";
  fs::copy_file(folder_ / "run.plate.pcd", old);
  written({{beams, plate(1)}});
  EXPECT_EQ(complaint(), "");
  fs::rename(old, folder_ / "run.plate.pcd");  // as a kill between the two files leaves them
  EXPECT_THAT(complaint(), HasSubstr("run.pcd and run.plate.pcd are of different runs"));
}

TEST_F(GrabMeasurements, ALaserThatTheRigDoesNotHaveIsRefused) {
  auto beams = sample_measurements(10);
  beams.laser[3] = 7;
  written({{beams, plate(1)}});
  EXPECT_THAT(complaint(), HasSubstr("run.pcd: has measurements of laser 8, but the rig has 3"));
}

TEST_F(GrabMeasurements, ACloudInPlaceOfMeasurementsIsRefusedByName) {
  PartsWriter writer(folder_ / "run.pcd", PcdFormat::binary);
  writer.write(to_pcd_table(test::sample_cloud(3)), false);
  writer.commit();
  EXPECT_THAT(complaint(), HasSubstr("run.pcd holds a cloud, no measurements; read it with grabber.cloud"));
}

TEST_F(GrabMeasurements, MeasurementsInPlaceOfACloudAreRefusedByName) {
  written({{sample_measurements(10), plate(1)}});
  try {
    StageDriver::of<GrabCloudStage>(file("run.pcd")).feed();
    FAIL() << "took measurements for a cloud";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("run.pcd holds measurements, no cloud; read it with grabber.pcd"));
  }
}

TEST_F(GrabMeasurements, AFolderIsRefused) {
  fs::create_directory(folder_ / "run.pcd");
  EXPECT_THAT(complaint(), HasSubstr("run.pcd is a folder, not a PCD file; name one file"));
}

TEST_F(GrabMeasurements, TheTwoFilesOfARecordingAreNamedAsTwo) {
  const auto stage = written({{sample_measurements(10), plate(1)}});
  EXPECT_THAT(stage.report().lines.back(), testing::EndsWith("run.pcd and run.plate.pcd"));
}

TEST_F(GrabMeasurements, ACloudIsReadByItsOwnGrabber) {
  PartsWriter writer(folder_ / "cloud.pcd", PcdFormat::binary);
  writer.write(to_pcd_table(test::sample_cloud(3)), false);
  writer.commit();
  auto stage = StageDriver::of<GrabCloudStage>(file("cloud.pcd"));
  stage.feed();
  EXPECT_EQ(stage.given<Cloud>().at(0)->at(2).time, test::sample_cloud(3)[2].time);
  EXPECT_THAT(stage.report().read, testing::ElementsAre(folder_ / "cloud.pcd"));
  EXPECT_THAT(stage.report().warnings, testing::IsEmpty());
}

TEST_F(GrabMeasurements, PointsBehindThoseThatTheHeaderGivesAreCountedAndWarnedOf) {
  write_file(folder_ / "long.pcd",
             "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nDATA ascii\n1 2 3\n4 5 6\n7 8 9\n");
  auto stage = StageDriver::of<GrabCloudStage>(file("long.pcd"));
  stage.feed();
  EXPECT_EQ(stage.given<Cloud>().at(0)->size(), 2U);
  EXPECT_EQ(stage.report().counts.at("points beyond the header's count"), 1U);
  EXPECT_THAT(stage.report().warnings, testing::ElementsAre(HasSubstr("long.pcd: 1 points follow the 2")));
}

TEST_F(GrabMeasurements, ACloudOfDoublesFarFromTheOriginIsWarnedOfUnlessItIsShifted) {
  PcdTable table(30);
  table.add<double>("x", [](std::size_t i) { return 691'607.5 + 0.1 * static_cast<double>(i); });
  table.add<double>("y", [](std::size_t i) { return 5'334'712.3 + 0.1 * static_cast<double>(i); });
  table.add<double>("z", [](std::size_t) { return 519.0; });
  AtomicFile out(folder_ / "utm.pcd");
  write_pcd(out, table, PcdFormat::binary);
  out.commit();
  auto options = file("utm.pcd");
  auto far = StageDriver::of<GrabCloudStage>(options);
  far.feed();
  ASSERT_EQ(far.report().warnings.size(), 1U);
  // Floats of 5e6 lie 0.5 m apart, so that one is changed by 0.25 m at the most; 5 334 712.8 becomes … 713.0
  // and 5 334 713.2 as well, by 0.2 m each.
  EXPECT_THAT(far.report().warnings[0],
              testing::AllOf(HasSubstr("are rounded to floats, which changes them by up to 0.2"),
                             HasSubstr("shift: [691600m, 5334700m, 500m]")));
  options["shift"] = std::vector<OptionScalar>{691'600.0, 5'334'700.0, 500.0};
  auto near = StageDriver::of<GrabCloudStage>(options);
  near.feed();
  EXPECT_THAT(near.report().warnings, testing::IsEmpty());
  const Cloud& cloud = *near.given<Cloud>().at(0);
  EXPECT_NEAR(cloud[29].x, 7.5 + 2.9, 1e-6);
  EXPECT_NEAR(cloud[29].y, 12.3 + 2.9, 1e-6);
  EXPECT_NEAR(cloud[29].z, 19, 1e-6);
}

TEST_F(GrabMeasurements, WarnsOfWhatOfAnotherProgramsCloudIsNotKept) {
  const auto warnings_of = [&](const std::string& more, const std::string& layout) {
    write_file(folder_ / "other.pcd", "VERSION 0.7\nFIELDS x y z intensity " + more +
                                          " _\nSIZE 4 4 4 4 4 4 1\nTYPE F F F F F F U\n" + layout +
                                          "POINTS 2\nDATA ascii\n1 2 3 4 5 6 0\n1 2 3 4 5 6 0\n");
    auto stage = StageDriver::of<GrabCloudStage>(file("other.pcd"));
    stage.feed();
    return stage.report().warnings;
  };
  EXPECT_THAT(
      warnings_of("rgb curvature", "WIDTH 1\nHEIGHT 2\nVIEWPOINT 0 0 1 1 0 0 0\n"),
      testing::ElementsAre((folder_ / "other.pcd").string() +
                           ": not kept are the fields rgb, curvature; the order in 2 rows; the VIEWPOINT"));
  EXPECT_THAT(warnings_of("beam time", "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0.0 0 0\n"), testing::IsEmpty());
}

}  // namespace
}  // namespace crisp
