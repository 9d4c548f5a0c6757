// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "tests/plugins/clock/aligned.hpp"

namespace crisp {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ClockDamage, CountsLostTelegramsAndStillKnowsTheMirrorsPeriod) {
  Random random(4);
  SimulatedLaser laser = three_lasers(4)[0];
  laser.is_lost = [&](double t) {
    return std::uniform_real_distribution<>(0, 1)(random) < 0.05 || (t > 3 && t < 3.3);
  };
  const auto turns = laser.turns(4, 0, 10);
  const auto all = SimulatedLaser(three_lasers(4)[0]).turns(4, 0, 10).size();
  const auto aligned = align({turns}, SimulatedPlate{}.readings(4, 10));
  EXPECT_EQ(aligned.report.devices[0].lost, all - turns.size());
  EXPECT_LT(beam_time_errors(aligned, 0, laser, turns).worst, 25e-6);
}

TEST(ClockDamage, MissesNothingOfADeviceThatCountsNothing) {
  auto readings = SimulatedPlate{}.readings(4, 10);
  std::int64_t k = 0;
  std::erase_if(readings, [&](const auto&) { return k++ % 7 == 3 || (k > 2000 && k < 4000); });
  for (PlateReading& reading : readings) reading.numbered = false;
  auto turns = three_lasers(4)[0].turns(4, 0, 10);
  turns.erase(turns.begin() + 20, turns.begin() + 60);
  for (auto& turn : turns) turn.scan.numbered = false;
  for (const auto& device : align({turns}, readings).report.devices) EXPECT_EQ(device.lost, 0u);
}

TEST(ClockDamage, CutsAtAResetOfALaserAndGoesOnAfterIt) {
  SimulatedLaser laser;
  laser.beams = 2;
  laser.clock.skew = [](double) { return 100e-6; };
  laser.clock.reset_at = 6;
  laser.is_lost = [](double t) { return t > 5.9 && t < 8; };
  const auto turns = laser.turns(6, 0, 20);
  const auto aligned = align({turns}, SimulatedPlate{}.readings(6, 20));
  EXPECT_EQ(aligned.report.devices[0].resets, 1u);
  EXPECT_EQ(aligned.report.devices[0].silences.size(), 1u);
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("laser1: its clock was reset 1 time(s)")));
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("laser1: silent 1 time(s)")));
  EXPECT_LT(beam_time_errors(aligned, 0, laser, turns).worst, 25e-6);
}

TEST(ClockDamage, LeavesOutWhatComesAfterThePlateHasLostItsZero) {
  SimulatedPlate plate;
  plate.clock.reset_at = 6;
  plate.forgets_count_at_reset = true;
  const auto aligned = align({SimulatedLaser{}.turns(6, 0, 10)}, plate.readings(6, 10));
  EXPECT_NEAR(static_cast<double>(aligned.report.counts.at("plate: readings after its zero was lost")), 2000,
              1);
  EXPECT_NEAR(aligned.stretches.front().plate.end(), kStart + 6, 0.01);
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("lost its zero")));
}

TEST(ClockDamage, GoesOnWhereOnlyThePlatesClockWasReset) {
  SimulatedPlate plate;
  plate.clock.reset_at = 6;
  const auto aligned = align({SimulatedLaser{}.turns(6, 0, 10)}, plate.readings(6, 10));
  EXPECT_EQ(aligned.report.devices[1].resets, 1u);
  EXPECT_EQ(aligned.report.counts.at("plate: readings after its zero was lost"), 0u);
  const auto& trajectory = aligned.stretches.front().plate;
  const double before = trajectory.at(kStart + 5)->angle;
  EXPECT_NEAR(trajectory.at(kStart + 8)->angle - before, 3 * 2 * std::numbers::pi, 1e-3);
}

TEST(ClockDamage, LeavesOutAnAngleThatThePlateCannotHaveReached) {
  auto readings = SimulatedPlate{}.readings(7, 10);
  readings[700].count ^= 0x400;
  readings[1500].count ^= 0x80000000;
  const auto aligned = align({SimulatedLaser{}.turns(7, 0, 10)}, readings);
  EXPECT_EQ(aligned.report.counts.at("plate: readings with an impossible angle"), 2u);
  EXPECT_EQ(aligned.stretches.front().plate.size(), readings.size() - 2);
  const auto& trajectory = aligned.stretches.front().plate;
  EXPECT_NEAR(trajectory.at(kStart + 8)->angle - trajectory.at(kStart + 1)->angle, 7 * 2 * std::numbers::pi,
              1e-3);
}

TEST(ClockDamage, DoesNotHoldTheRestAgainstADamagedFirstReading) {
  auto readings = SimulatedPlate{}.readings(7, 4);
  readings[0].count ^= 0x400000;
  const auto aligned = align({SimulatedLaser{}.turns(7, 0, 4)}, readings);
  EXPECT_EQ(aligned.stretches.front().plate.size(), readings.size() - 5);  // it takes five to outvote it
  EXPECT_THAT(aligned.report.warnings, ::testing::IsEmpty());
}

TEST(ClockDamage, GoesOnAsBeforeWhereTheCountHasJumped) {
  auto readings = SimulatedPlate{}.readings(7, 10);
  const auto as_it_was = align({SimulatedLaser{}.turns(7, 0, 10)}, readings);
  for (std::size_t i = 3000; i < readings.size(); ++i) readings[i].count += 5000;
  for (std::size_t i = 3500; i < readings.size(); ++i) readings[i].count -= 700;
  const auto aligned = align({SimulatedLaser{}.turns(7, 0, 10)}, readings);
  const PlateTrajectory& plate = aligned.stretches.front().plate;
  ASSERT_EQ(plate.size(), readings.size());
  for (std::size_t i = 2990; i < readings.size(); ++i)
    ASSERT_NEAR(plate.angles()[i], as_it_was.stretches.front().plate.angles()[i], 2e-4) << i;
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("its count jumped 2 time(s), by +")));
}

TEST(ClockDamage, CountsTurnsOfAnEncoderThatCountsAnewAtItsIndexPulse) {
  auto readings = SimulatedPlate{}.readings(7, 10);
  const auto as_it_was = align({SimulatedLaser{}.turns(7, 0, 10)}, readings);
  const auto of_turn = static_cast<std::uint32_t>(default_rig().plate.counts_per_revolution);
  for (PlateReading& reading : readings) reading.count %= of_turn;
  const auto aligned = align({SimulatedLaser{}.turns(7, 0, 10)}, readings);
  const PlateTrajectory& plate = aligned.stretches.front().plate;
  ASSERT_EQ(plate.size(), readings.size());
  EXPECT_THAT(aligned.report.warnings, ElementsAre(HasSubstr("its count begins anew after whole turns")));
  const double first = as_it_was.stretches.front().plate.angles()[0] - plate.angles()[0];
  for (std::size_t i = 0; i < readings.size(); ++i)
    ASSERT_NEAR(plate.angles()[i] + first, as_it_was.stretches.front().plate.angles()[i], 1e-7) << i;
}

TEST(ClockDamage, LeavesOutWhatComesAfterTheCountHasJumpedInASilence) {
  auto readings = SimulatedPlate{}.readings(7, 10);
  for (std::size_t i = 3000; i < readings.size(); ++i) readings[i].count += 5'000'000;
  readings.erase(readings.begin() + 2970, readings.begin() + 3000);  // a plate may change its rate meanwhile
  const auto aligned = align({SimulatedLaser{}.turns(7, 0, 10)}, readings);
  EXPECT_EQ(aligned.stretches.front().plate.size(), 2970u);
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("lost its zero")));
}

TEST(ClockDamage, LeavesOutADamagedStampInsteadOfCuttingThere) {
  auto turns = SimulatedLaser{}.turns(8, 0, 5);
  turns[100].scan.scan_time_us ^= 0x40000000;
  turns[100].scan.transmission_time_us ^= 0x40000000;
  turns[150].scan.scan_time_us ^= 0x40000000;  // only one of the two
  auto readings = SimulatedPlate{}.readings(8, 5);
  readings[1000].device_us ^= 0x10000000;
  const auto aligned = align({turns}, readings);
  EXPECT_EQ(aligned.report.devices[0].damaged, 2u);
  EXPECT_EQ(aligned.report.devices[0].resets, 0u);
  EXPECT_EQ(aligned.of_laser(0).size(), turns.size() - 2);
  EXPECT_EQ(aligned.report.devices[1].damaged, 1u);
  EXPECT_EQ(aligned.stretches.front().plate.size(), readings.size() - 1);
}

TEST(ClockDamage, SetsAsideWhatComesTwice) {
  auto turns = SimulatedLaser{}.turns(9, 0, 3);
  turns.insert(turns.begin() + 50, turns[49]);
  const auto aligned = align({turns}, SimulatedPlate{}.readings(9, 3));
  EXPECT_EQ(aligned.report.devices[0].repeated, 1u);
  EXPECT_EQ(aligned.of_laser(0).size(), turns.size() - 1);
}

TEST(ClockDamage, NamesThePeriodOffsetThatAFirmwareNeeds) {
  SimulatedLaser laser;
  laser.stamped_turns_late = 1;
  const auto turns = laser.turns(1, 0, 5);
  const auto readings = SimulatedPlate{}.readings(1, 5);
  EXPECT_THAT(align({turns}, readings).report.warnings, Contains(HasSubstr("period_offset: -1")));

  Rig rig = default_rig();
  rig.lasers[0].period_offset = -1;
  const auto aligned = align({turns}, readings, {}, rig);
  EXPECT_TRUE(aligned.report.warnings.empty());
  EXPECT_LT(beam_time_errors(aligned, 0, laser, turns).worst, 25e-6);
}

TEST(ClockDamage, CountsBeamsWithoutEchoAndNamesALaserThatSeesNothing) {
  std::vector<Turns> lasers{three_lasers(4)[0].turns(4, 0, 5), three_lasers(4)[1].turns(4, 1, 5)};
  for (auto& turn : lasers[0]) turn.scan.echoes[0].ranges[7] = 0;
  std::size_t beams = 0;
  for (auto& turn : lasers[1]) {
    beams += turn.scan.echoes[0].ranges.size();
    std::ranges::fill(turn.scan.echoes[0].ranges, 0.0F);
  }
  const auto report = align(lasers, SimulatedPlate{}.readings(4, 5)).report;
  EXPECT_EQ(report.counts.at("laser1: beams without echo"), lasers[0].size());
  EXPECT_EQ(report.counts.at("laser2: beams without echo"), beams);
  EXPECT_THAT(report.warnings,
              ElementsAre(HasSubstr("laser2: none of its " + std::to_string(beams) + " beams")));
}

TEST(ClockDamage, NamesADeviceThatIsMissing) {
  const auto aligned = align({SimulatedLaser{}.turns(1, 0, 2), {}}, SimulatedPlate{}.readings(1, 2));
  EXPECT_THAT(aligned.report.warnings, Contains("laser2: no data of it"));
  EXPECT_THROW(align({SimulatedLaser{}.turns(1, 0, 2)}, {}), Error);
  EXPECT_THROW(align({{}}, SimulatedPlate{}.readings(1, 2)), Error);
}

TEST(ClockDamage, PlacesALaserThatIsHeardInTheFirstHalfSecondOnly) {
  // The epoch is a whole second, and the first telegrams come before it.
  for (const double until : {0.1, 0.45}) {
    SimulatedLaser early;
    early.is_lost = [=](double t) { return t > until; };
    const auto turns = early.turns(4, 0, 8);
    auto readings = SimulatedPlate{}.readings(4, 8);
    std::vector<Turns> lasers{turns, three_lasers(4)[1].turns(4, 1, 8)};
    for (auto& laser : lasers) {
      for (auto& turn : laser) turn.scan.receipt_ns += 300'000'000;
    }
    for (auto& reading : readings) reading.receipt_ns += 300'000'000;
    for (const auto& aligned : {align(lasers, readings), align_online(lasers, readings)}) {
      EXPECT_EQ(aligned.of_laser(0).size(), turns.size());
      EXPECT_TRUE(aligned.report.devices[0].clock);
      EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("laser1: silent 1 time(s)")));
    }
  }
}

TEST(ClockDamage, PlacesWhatAPlateCoversThatIsHeardInTheFirstHalfSecondOnly) {
  SimulatedPlate early;
  early.is_lost = [](double t) { return t > 0.2; };
  const auto turns = SimulatedLaser{}.turns(4, 0, 8);
  auto readings = early.readings(4, 8);
  const auto aligned = align({turns}, readings);
  EXPECT_EQ(aligned.of_laser(0).size(), turns.size());
  EXPECT_EQ(aligned.stretches.front().plate.size(), readings.size());
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("plate: silent 1 time(s)")));
}

TEST(ClockDamage, RefusesAPlateWhoseClockStandsStill) {
  auto readings = SimulatedPlate{}.readings(4, 5);
  for (auto& reading : readings) reading.device_us = 77;
  const auto turns = SimulatedLaser{}.turns(4, 0, 5);
  for (const bool online : {false, true}) {
    try {
      online ? align_online({turns}, readings) : align({turns}, readings);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("plate: its clock stands still: 2499 of 2500 readings"));
    }
  }
}

TEST(ClockDamage, PlacesByReceiptsWhereRequestedToAndAClockStandsStill) {
  auto readings = SimulatedPlate{}.readings(4, 5);
  for (auto& reading : readings) reading.device_us = 77;
  auto turns = SimulatedLaser{}.turns(4, 0, 5);
  for (auto& turn : turns) turn.scan.scan_time_us = turn.scan.transmission_time_us = 0;
  const auto aligned = align({turns}, readings, {.source = TimeSource::receipt});
  EXPECT_EQ(aligned.of_laser(0).size(), turns.size() - 5) << "it takes five to see that it stands";
  EXPECT_EQ(aligned.stretches.front().plate.size(), readings.size() - 5);
  EXPECT_THAT(aligned.report.caveats, ::testing::ElementsAre(HasSubstr("laser1: its clock stands still"),
                                                             HasSubstr("plate: its clock stands still")));
  EXPECT_THAT(aligned.report.warnings, ::testing::Not(Contains(HasSubstr("reset"))));
}

TEST(ClockDamage, MarksALaserWithAStandingClockUntrusted) {
  auto lasers = std::vector{SimulatedLaser{}.turns(4, 0, 5), SimulatedLaser{}.turns(5, 1, 5)};
  for (auto& turn : lasers[1]) turn.scan.scan_time_us = turn.scan.transmission_time_us = 0;
  const auto aligned = align(lasers, SimulatedPlate{}.readings(4, 5));
  EXPECT_THAT(aligned.report.caveats,
              ::testing::ElementsAre(HasSubstr("laser2: its clock stands still (for 5.0 s): 248 of 249")));
  EXPECT_EQ(aligned.report.devices[1].standing, lasers[1].size() - 1);
  EXPECT_EQ(aligned.report.devices[1].repeated, 0U) << "none came twice";
  EXPECT_EQ(aligned.of_laser(0).size(), lasers[0].size());
}

TEST(ClockDamage, WarnsOfALaserOfWhichMoreThanAFewScansAreOfNoUse) {
  const auto report_with = [](std::size_t every) {
    auto turns = SimulatedLaser{}.turns(4, 0, 5);
    for (std::size_t i = every; i < turns.size(); i += every) {
      turns[i].scan.transmission_time_us = turns[i].scan.scan_time_us - 300'000;
    }
    return align({turns}, SimulatedPlate{}.readings(4, 5)).report;
  };
  EXPECT_THAT(report_with(50).warnings, ::testing::IsEmpty());
  const auto report = report_with(10);
  EXPECT_THAT(report.warnings,
              Contains(HasSubstr("laser1: 24 of 249 telegrams (9.6 %) have times inconsistent")));
  EXPECT_THAT(report.caveats, ::testing::IsEmpty());
}

TEST(ClockDamage, NamesAClockThatTicksTooCoarsely) {
  auto readings = SimulatedPlate{}.readings(4, 5);
  for (auto& reading : readings) reading.device_us -= reading.device_us % 10'000;
  const auto report = align({SimulatedLaser{}.turns(4, 0, 5)}, readings).report;
  EXPECT_THAT(report.warnings,
              Contains(HasSubstr("plate: its clock's resolution is too coarse: 2000 of 2500")));
}

TEST(ClockDamage, SurvivesNonsense) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    auto lasers = three_lasers(seed);
    std::vector<Turns> turns;
    for (std::uint16_t i = 0; i < 3; ++i) turns.push_back(lasers[i].turns(seed, i, 100));
    auto readings = SimulatedPlate{}.readings(seed, 100);
    const auto bits = [&] { return static_cast<std::uint32_t>(random()); };
    for (std::size_t k = 0; k < 20 * seed; ++k) {  // the higher the seed, the worse
      Scan& scan = turns[bits() % 3][bits() % 4000].scan;
      switch (bits() % 8) {
        case 0:
          scan.scan_time_us = bits();
          break;
        case 1:
          scan.transmission_time_us = bits();
          break;
        case 2:
          scan.scan_counter = static_cast<std::uint16_t>(bits());
          break;
        case 3:
          scan.receipt_ns += static_cast<std::int64_t>(bits() % 100) * 1'000'000'000;
          break;
        case 4:
          scan.scan_frequency = 0;
          break;
        case 5:
          scan.echoes.clear();
          break;
        case 6:
          if (!scan.echoes.empty()) scan.echoes[0].ranges[0] = std::numeric_limits<float>::quiet_NaN();
          break;
        default:
          scan.laser = static_cast<std::uint16_t>(bits());
      }
      auto& reading = readings[bits() % readings.size()];
      (bits() % 2 ? reading.device_us : reading.count) = bits();
      reading.sequence = static_cast<std::uint16_t>(bits());
    }
    try {
      const auto aligned = align(turns, readings);
      std::size_t scans = 0;
      for (const auto& stretch : aligned.stretches) {
        for (const auto& scan : stretch.scans) {
          ++scans;
          for (const double time : scan.time) ASSERT_TRUE(std::isfinite(time)) << "seed " << seed;
          for (const float range : scan.range) ASSERT_GT(range, 0) << "seed " << seed;
        }
      }
      const std::size_t sent = turns[0].size() + turns[1].size() + turns[2].size();
      EXPECT_GT(scans, 0.9 * static_cast<double>(sent)) << "seed " << seed;
    } catch (const Error&) {  // also a good answer
    }
  }
}

}  // namespace
}  // namespace crisp
