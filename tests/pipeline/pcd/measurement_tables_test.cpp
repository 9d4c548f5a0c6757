// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>

#include <crisp/error.hpp>
#include <crisp/measurement_tables.hpp>

#include "pipeline/pcd/parts.hpp"
#include "tests/pipeline/pcd/sample_tables.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::pcd;
using test::sample_measurements;
using test::sample_plate;

PcdTable through_a_file(const PcdTable& table, PcdFormat format) {
  const test::TemporaryFolder folder;
  PartsWriter parts(folder / "x.pcd", format);
  return read_pcd((parts.write(table, false), parts.commit().front()));
}

class MeasurementFormats : public testing::TestWithParam<PcdFormat> {};

TEST_P(MeasurementFormats, MeasurementsComeBackExactly) {
  const Measurements beams = sample_measurements(3000);
  const auto read = measurements_of(through_a_file(to_pcd_table(beams, sample_plate(1)), GetParam()));
  EXPECT_EQ(read.impossible, 0U);
  EXPECT_EQ(read.beams.epoch_ns, beams.epoch_ns);
  EXPECT_EQ(read.beams.range, beams.range);
  EXPECT_EQ(read.beams.mirror_angle, beams.mirror_angle);
  EXPECT_EQ(read.beams.time, beams.time);
  EXPECT_EQ(read.beams.laser, beams.laser);
  EXPECT_EQ(read.beams.remission, beams.remission);
  EXPECT_EQ(read.beams.beam, beams.beam);
}

TEST_P(MeasurementFormats, ATrajectoryComesBackExactly) {
  const PlateTrajectory plate = sample_plate(1);
  const auto read = trajectory_of(through_a_file(to_pcd_table(plate), GetParam()));
  EXPECT_EQ(read.epoch_ns(), plate.epoch_ns());
  EXPECT_EQ(read.max_gap(), plate.max_gap());
  ASSERT_EQ(read.size(), plate.size());
  for (double t = -0.1; t < 1.1; t += 0.00037) {
    const auto expected = plate.at(t);
    const auto actual = read.at(t);
    ASSERT_EQ(actual.has_value(), expected.has_value());
    if (!expected) continue;
    ASSERT_EQ(actual->angle, expected->angle);
    ASSERT_EQ(actual->rate, expected->rate);
  }
}

TEST_P(MeasurementFormats, NewZerosOfTheEncoderComeBack) {
  const PlateTrajectory plate(5, {0, 1, 2, 3}, {0, 1, 0, 1}, 1, {1.5, 3});
  const auto read = trajectory_of(through_a_file(to_pcd_table(plate), GetParam()));
  ASSERT_EQ(read.new_zeros().size(), 2U);
  EXPECT_EQ(read.new_zeros()[0], 2) << "the first reading that counts from it";
  EXPECT_EQ(read.new_zeros()[1], 3);
}

INSTANTIATE_TEST_SUITE_P(All, MeasurementFormats,
                         testing::Values(PcdFormat::ascii, PcdFormat::binary, PcdFormat::binary_compressed));

TEST(MeasurementTables, ThePlatesAngleStandsNextToEachMeasurement) {
  Measurements beams = sample_measurements(2);
  beams.time = {0.5, 2.0};
  const auto angles = to_pcd_table(beams, sample_plate(1)).column<double>("plate_angle");
  EXPECT_NEAR(angles[0], 1.0 / 3 + 6 * 0.25, 1e-12);  // the angle that sample_plate gives this instant
  EXPECT_TRUE(std::isnan(angles[1])) << "the readings end at 1 s";
}

TEST(MeasurementTables, WithoutATrajectoryOneIsMadeOfTheAngles) {
  // One turn in 0.1 s, its angles wrapped; two lasers, so that times come twice and out of order.
  PcdTable table(2000);
  const auto time = [](std::size_t i) { return static_cast<double>(i % 1000) * 1e-3; };
  table.add<double>("time", time);
  table.add<double>("plate_angle", [&](std::size_t i) {
    return std::remainder(time(i) * 20 * std::numbers::pi, 2 * std::numbers::pi);
  });
  const auto plate = trajectory_between(table, 0.02);
  EXPECT_EQ(plate.size(), 1000U);
  EXPECT_NEAR(plate.at(0.9985)->angle, 0.9985 * 20 * std::numbers::pi, 1e-9);
}

TEST(MeasurementTables, ImpossibleMeasurementsAreCountedAndLeftOut) {
  Measurements beams = sample_measurements(4);
  beams.range[0] = 0;
  beams.range[1] = -1;
  beams.time[2] = std::numeric_limits<double>::quiet_NaN();
  const auto read = measurements_of(to_pcd_table(beams, sample_plate(1)));
  EXPECT_EQ(read.impossible, 3U);
  EXPECT_EQ(read.beams.range, std::vector<float>{beams.range[3]});
}

TEST(MeasurementTables, ATrajectoryOfNoNumbersOrOfTimesThatDoNotAscendIsRefused) {
  const auto with_times = [](double first, double second) {
    PcdTable table(2);
    table.set_note("max_gap", "0.1");
    table.add<double>("time", [=](std::size_t i) { return i == 0 ? first : second; });
    table.add<double>("angle", [](std::size_t) { return 0.0; });
    return table;
  };
  EXPECT_NO_THROW(trajectory_of(with_times(0, 1)));
  EXPECT_THROW(trajectory_of(with_times(1, 1)), Error);
  EXPECT_THROW(trajectory_of(with_times(0, std::numeric_limits<double>::quiet_NaN())), Error);
}

TEST(MeasurementTables, ACloudIsNotTakenForMeasurements) {
  PcdTable cloud(1);
  for (const char* field : {"x", "y", "z"}) cloud.add<float>(field, [](std::size_t) { return 1.0F; });
  EXPECT_THROW(measurements_of(cloud), Error);
}

}  // namespace
}  // namespace crisp
