// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/simd_placement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <crisp/sensor_model.hpp>

#include "tests/pipeline/model/support.hpp"
#include "tests/support/instruction_sets.hpp"

namespace crisp {
namespace {

/// A term that changes nothing, but makes a laser's chain one that is not bare.
struct Nothing final : DifferentiableTerm<Nothing> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{.name = "test.nothing", .phase = Phase::kRange, .scope = Scope::kLaser};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>&, std::span<const T>) const {}
};

Calibration three_lasers() {
  Calibration calibration = one_laser(0.1, 0.2, -0.03, 0.004);
  calibration.lasers.push_back(one_laser(2.2, 0.18, 0.5, -0.01).lasers.front());
  calibration.lasers.push_back(one_laser(-2.5, 0, 0, 0).lasers.front());
  return calibration;
}

/// The same with the term that changes nothing in the chains of the first `lasers` of them.
SensorModel through_terms(std::size_t lasers) {
  TermRegistry terms;
  terms.add(std::make_shared<Nothing>());
  Calibration calibration = three_lasers();
  for (std::size_t i = 0; i < lasers; ++i) calibration.lasers[i].terms.push_back({"test.nothing", {}});
  return SensorModel(calibration, terms);
}

/// Turns for 4 s, with readings at uneven times and two silences that are not interpolated across.
PlateTrajectory interrupted_plate() {
  std::vector<double> times, angles;
  for (double t = 1; t < 5; t += 0.002 + 0.0007 * std::sin(1e5 * t)) {
    if ((t > 2 && t < 2.1) || (t > 3.5 && t < 3.6)) continue;
    times.push_back(t);
    angles.push_back(2000 + 6 * t + std::sin(3 * t));
  }
  return {0, times, angles, 0.01};
}

/// Beams from before the plate's first reading to after its last: runs of a laser of random lengths, times
/// that ascend within a run and overlap between them, and some that lie exactly on readings.
Measurements runs_of_beams(std::size_t n, std::size_t longest_run) {
  std::mt19937_64 random(n);
  std::uniform_real_distribution<float> range(0.05F, 80), angle(-8, 8);
  std::uniform_real_distribution<double> jump(-0.05, 0.05);
  std::uniform_int_distribution<std::size_t> length(1, longest_run);
  const PlateTrajectory plate = interrupted_plate();
  Measurements beams;
  while (beams.size() < n) {
    const auto laser = static_cast<std::uint16_t>(random() % 3);
    const double place = static_cast<double>(beams.size()) / static_cast<double>(n);
    const double begin = 0.8 + 4.4 * place + jump(random);
    const std::size_t end = std::min(n, beams.size() + length(random));
    for (std::size_t i = 0; beams.size() < end; ++i) {
      Measurements beam = one_beam(range(random), angle(random));
      beam.laser[0] = laser;
      beam.time[0] = begin + 37e-6 * static_cast<double>(i);
      if (laser == 2 && i % 50 == 7) beam.time[0] = plate.times()[random() % plate.size()];
      beams.append(beam);
    }
  }
  return beams;
}

void expect_same(const Placed& one, const Placed& other) {
  ASSERT_EQ(one.index, other.index);
  if (one.index.empty()) return;
  // 80 m away and 2000 rad on, the angle's own rounding is 2e-11 m.
  EXPECT_LT((one.points - other.points).cwiseAbs().maxCoeff(), 1e-10);
}

class BaseKinematics : public test::EachInstructionSet {};

INSTANTIATE_TEST_SUITE_P(All, BaseKinematics, testing::ValuesIn(test::instruction_sets()),
                         test::name_of_instruction_set);

TEST_P(BaseKinematics, HasASineAndACosineThatAreRightToRounding) {
  std::vector<double> angles;
  for (int i = -200000; i <= 200000; ++i) angles.push_back(1e-4 * i);
  for (int i = -1000; i <= 1000; ++i) {
    const double quarter = i * 1.57079632679489661923;
    for (const double off : {0.0, 1e-9, -1e-9, 0.78539816339744831}) angles.push_back(quarter + off);
  }
  for (const double angle : {1e5, -1e5, 1.5e6, 3.3e6, -7.7e7, 1e9}) angles.push_back(angle);
  std::vector<double> sine(angles.size()), cosine(angles.size());
  simd::sine_cosine(angles.data(), angles.size(), sine.data(), cosine.data());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double size = std::abs(angles[i]);
    const double rounding = std::numeric_limits<double>::epsilon() * (size < 1.6e6 ? 2 : size);
    ASSERT_NEAR(sine[i], std::sin(angles[i]), rounding) << angles[i];
    ASSERT_NEAR(cosine[i], std::cos(angles[i]), rounding) << angles[i];
  }
}

/// A scan whose beams go from `first_angle` on in even steps; of some there is no echo, of others each time.
Measurements scan_of(std::uint16_t laser, float first_angle, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> range(0.05F, 80);
  Measurements scan;
  for (int k = 0; k < 541; ++k) {
    if (random() % 40 == 0) continue;
    Measurements beam = one_beam(range(random), first_angle + 0.0087F * static_cast<float>(k));
    beam.laser[0] = laser;
    beam.beam[0] = static_cast<std::uint16_t>(k);
    beam.time[0] = 1.5 + 37e-6 * k;
    scan.append(beam);
  }
  return scan;
}

std::vector<double> coordinates(const SensorModel& model, const Measurements& beams,
                                MirrorAngleCache& known) {
  std::vector<double> all;
  const TakePlaced take = [&](const PlacedRun& run) {
    for (const auto& axis : {run.x, run.y, run.z}) all.insert(all.end(), axis.begin(), axis.end());
  };
  model.place(beams, interrupted_plate(), take, known);
  return all;
}

TEST_P(BaseKinematics, KeepsSinesFromScanToScanAndNoticesOtherAngles) {
  const SensorModel bare(three_lasers());
  MirrorAngleCache known;
  unsigned seed = 0;
  for (const auto& [laser, first_angle] : std::vector<std::pair<std::uint16_t, float>>{
           {0, -2.3F}, {0, -2.3F}, {1, -2.3F}, {0, -2.2978F}, {0, -2.3F}, {1, 1.0F}, {0, -2.3F}, {1, 1.0F}}) {
    const Measurements scan = scan_of(laser, first_angle, ++seed);
    MirrorAngleCache none;
    const auto kept = coordinates(bare, scan, known);
    EXPECT_EQ(kept.size(), 3 * scan.size());
    EXPECT_EQ(kept, coordinates(bare, scan, none)) << seed;
  }
}

TEST_P(BaseKinematics, PlacesBeamsWhereTheChainWithTermsDoes) {
  const SensorModel bare(three_lasers());
  const PlateTrajectory plate = interrupted_plate();
  for (const std::size_t longest : {1U, 5U, 700U, 5000U}) {
    const auto beams = runs_of_beams(12000, longest);
    const auto placed = bare.place(beams, plate);
    EXPECT_GT(placed.index.size(), 9000U);
    EXPECT_LT(placed.index.size(), 11500U);
    expect_same(placed, through_terms(3).place(beams, plate));
    expect_same(placed, through_terms(1).place(beams, plate));
  }
}

TEST_P(BaseKinematics, HasTheDerivativesOfTheChainWithTerms) {
  const std::vector<std::size_t> free = {0, 1, 3, 4, 5, 6, 7, 10};
  const PlateTrajectory plate = interrupted_plate();
  for (const std::size_t longest : {1U, 700U}) {
    const auto beams = runs_of_beams(3000, longest);
    PointDerivatives bare, automatic;
    expect_same(SensorModel(three_lasers()).place(beams, plate, free, bare),
                through_terms(3).place(beams, plate, free, automatic));
    EXPECT_EQ(bare.columns, automatic.columns);
    ASSERT_EQ(bare.values.cols(), automatic.values.cols());
    // 80 m at up to 9 rad/s, and the angle's own rounding
    EXPECT_LT((bare.values - automatic.values).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST_P(BaseKinematics, PlacesAnyNumberOfBeams) {
  const SensorModel bare(three_lasers());
  const PlateTrajectory plate = interrupted_plate();
  for (std::size_t n = 0; n < 70; ++n) {
    const auto beams = runs_of_beams(n, 40);
    expect_same(bare.place(beams, plate), through_terms(3).place(beams, plate));
  }
}

TEST_P(BaseKinematics, PlacesABeamTheSameWhateverIsAroundIt) {
  const SensorModel bare(three_lasers());
  const PlateTrajectory plate = interrupted_plate();
  const auto beams = runs_of_beams(3000, 600);
  const auto placed = bare.place(beams, plate);
  for (std::size_t i = 0; i < placed.index.size(); ++i) {
    Measurements one;
    one.append(beams, placed.index[i]);
    const auto alone = bare.place(one, plate);
    ASSERT_EQ(alone.points.cols(), 1);
    // to the last bit: the same interval of the plate, unless the time is a reading's
    if (beams.laser[placed.index[i]] == 2) continue;
    ASSERT_EQ(alone.points.col(0), placed.points.col(static_cast<Eigen::Index>(i)));
  }
}

TEST_P(BaseKinematics, LeavesOutEverythingWithoutReadingsOfThePlate) {
  const SensorModel bare(three_lasers());
  const auto beams = runs_of_beams(100, 10);
  EXPECT_TRUE(bare.place(beams, PlateTrajectory()).index.empty());
  EXPECT_TRUE(bare.place(Measurements(), interrupted_plate()).index.empty());
}

}  // namespace
}  // namespace crisp
