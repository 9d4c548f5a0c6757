// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/clock_aligner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pipeline/data/error.hpp"
#include "tests/plugins/clock/simulated_scanner.hpp"

namespace crisp {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)
using ::testing::Contains;
using ::testing::HasSubstr;

struct Aligned {
  struct Stretch {
    PlateTrajectory plate;
    std::vector<Measurements> scans;
  };
  std::vector<Stretch> stretches;
  AlignmentReport report;

  std::vector<const Measurements*> of_laser(std::uint16_t laser) const {
    std::vector<const Measurements*> found;
    for (const auto& stretch : stretches) {
      for (const auto& scan : stretch.scans) {
        if (scan.laser.front() == laser) found.push_back(&scan);
      }
    }
    return found;
  }
};

using Turns = std::vector<SimulatedLaser::Turn>;

/// Feeds all telegrams in the order of their receipt.
Aligned align(const std::vector<Turns>& lasers, const std::vector<PlateReading>& readings,
              const AlignmentSettings& settings = {}, Rig rig = default_rig()) {
  Aligned out;
  rig.lasers.resize(lasers.size());
  ClockAligner aligner(
      rig, settings,
      {.trajectory =
           [&](PlateTrajectory p) {
             out.stretches.push_back({std::move(p), {}});
           },
       .measurements = [&](Measurements m) { out.stretches.back().scans.push_back(std::move(m)); }});
  std::multimap<std::int64_t, std::function<void()>> arrivals;
  for (const auto& turns : lasers) {
    for (const auto& turn : turns) {
      arrivals.emplace(turn.scan.receipt_ns, [&] { aligner.add(std::make_shared<const Scan>(turn.scan)); });
    }
  }
  for (const auto& reading : readings) {
    arrivals.emplace(reading.receipt_ns, [&] { aligner.add(reading); });
  }
  for (const auto& [receipt, arrive] : arrivals) arrive();
  out.report = aligner.finish();
  return out;
}

struct TimeErrors {
  double median = 0;  ///< [s] of the absolute errors
  double worst = 0;   ///< [s]
};

/// How far the beams' hub times are from the true times plus the least delay of their laser.
TimeErrors beam_time_errors(const Aligned& aligned, std::uint16_t index, const SimulatedLaser& laser,
                            const Turns& turns) {
  const auto scans = aligned.of_laser(index);
  EXPECT_EQ(scans.size(), turns.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < std::min(scans.size(), turns.size()); ++i) {
    for (const std::size_t k : {std::size_t{0}, scans[i]->size() - 1}) {
      const double fired = turns[i].begin + (k == 0 ? 0 : 0.75 * turns[i].period);
      errors.push_back(std::abs(scans[i]->time[k] - (kStart + fired + laser.minimum_delay)));
    }
  }
  if (errors.empty()) return {HUGE_VAL, HUGE_VAL};
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors.back()};
}

/// Three lasers with skews up to 250 ppm and mirrors up to 0.6 % slow that wander.
std::vector<SimulatedLaser> three_lasers(std::uint64_t seed) {
  Random random(seed);
  std::vector<SimulatedLaser> lasers(3);
  for (auto& laser : lasers) {
    const double skew = std::uniform_real_distribution<>(-250e-6, 250e-6)(random);
    const double slow = std::uniform_real_distribution<>(0, 6e-3)(random);
    laser.clock.start = std::uniform_real_distribution<>(0, 4294)(random);
    laser.clock.skew = [=](double) { return skew; };
    laser.period = [=](double t) { return 0.02 * (1 + slow + 2e-3 * std::sin(1.7 * t + 100 * slow)); };
    laser.beams = 9;
  }
  return lasers;
}

TEST(ClockAligner, FindsWhenEachBeamWasFired) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto lasers = three_lasers(seed);
    std::vector<Turns> turns;
    for (std::uint16_t i = 0; i < 3; ++i) turns.push_back(lasers[i].turns(seed, i, 10));
    const auto aligned = align(turns, SimulatedPlate{}.readings(seed, 10));
    ASSERT_EQ(aligned.stretches.size(), 1u);
    for (std::uint16_t i = 0; i < 3; ++i) {
      // Delays of 100 us on the mean leave the line of 500 stamps about a microsecond open; stamps are whole
      // microseconds; the bend of the mirror's motion within a turn is 2 us.
      const auto errors = beam_time_errors(aligned, i, lasers[i], turns[i]);
      EXPECT_LT(errors.median, 4e-6) << "seed " << seed << " laser " << i;
      EXPECT_LT(errors.worst, 15e-6) << "seed " << seed << " laser " << i;
      EXPECT_NEAR(aligned.report.devices[i].clock.skew_ppm(), 1e6 * lasers[i].clock.skew(0), 2);
      EXPECT_EQ(aligned.report.devices[i].lost, 0u);
    }
  }
}

TEST(ClockAligner, GivesThePlatesAngleOnTheHubsClock) {
  SimulatedPlate plate;
  plate.clock = {.start = 4290, .skew = [](double) { return -180e-6; }};  // its clock wraps after 5 s
  plate.angle = [](double t) { return 5 * std::sin(2 * t) - 3 * t; };     // and its count several times
  SimulatedLaser laser;
  const auto aligned = align({laser.turns(1, 0, 10)}, plate.readings(1, 10));
  const auto& trajectory = aligned.stretches.front().plate;
  double zero = 0;
  for (double t = 0.5; t < 9.5; t += 0.0137) {
    const auto state = trajectory.at(kStart + t + plate.minimum_delay);
    ASSERT_TRUE(state) << t;
    if (zero == 0) zero = state->angle - plate.angle(t);
    // Counts are whole: half a step of 0.38 mrad on either side; 13 rad/s in 3 us are 0.04 mrad.
    EXPECT_NEAR(state->angle - plate.angle(t), zero, 0.5e-3) << t;
  }
}

TEST(ClockAligner, TakesTheEpochAtTheWholeSecondBeforeTheFirstReceipt) {
  const auto aligned = align({SimulatedLaser{}.turns(1, 0, 1)}, SimulatedPlate{}.readings(1, 1));
  EXPECT_EQ(aligned.stretches.front().plate.epoch_ns(), 1'700'000'000'000'000'000);
  EXPECT_EQ(aligned.stretches.front().scans.front().epoch_ns, 1'700'000'000'000'000'000);
}

TEST(ClockAligner, FollowsAClockThatDriftsOverAnHourAndHandsOutAsItGoes) {
  // 5 ppm an hour make one line 1.6 ms wrong; 50 Hz for an hour, so scans of one beam.
  SimulatedLaser laser;
  laser.beams = 2;
  laser.delays = exponential_delays(3e-4);
  laser.clock.skew = [](double t) { return 40e-6 + 5e-6 * t / 3600; };
  const auto turns = laser.turns(3, 0, 3600);
  SimulatedPlate plate;
  plate.clock.skew = [](double t) { return -90e-6 - 5e-6 * t / 3600; };
  const auto aligned = align({turns}, plate.readings(3, 3600));
  EXPECT_GT(aligned.stretches.size(), 40u);
  const auto errors = beam_time_errors(aligned, 0, laser, turns);
  // A line through 60 s is off by up to 0.6 us from the drift, by 1 to 2 us from the delays, and stamps are
  // whole us.
  EXPECT_LT(errors.median, 2e-6);
  EXPECT_LT(errors.worst, 8e-6);
  double worst_angle = 0;
  for (const auto& stretch : aligned.stretches) {
    if (&stretch != &aligned.stretches.front()) {
      EXPECT_LE(stretch.plate.begin(), stretch.scans.front().time.front() - 0.25);
    }
    for (const auto& scan : stretch.scans) {
      const auto state = stretch.plate.at(scan.time.front());
      ASSERT_TRUE(state);
      // One turn a second: the angle shows the plate's time, shifted by its least delay.
      const double shown = std::fmod(state->angle / (2 * std::numbers::pi) + 0x100 / 16384.0, 1);
      const double due = std::fmod(scan.time.front() - kStart - plate.minimum_delay, 1);
      worst_angle = std::max(worst_angle, std::abs(std::remainder(shown - due, 1)));
    }
  }
  EXPECT_LT(worst_angle, 60e-6);  // half a step of the encoder is 31 us here
}

TEST(ClockAligner, GivesScansInTheOrderOfTheirBeginningsOverAllLasers) {
  const auto lasers = three_lasers(5);
  std::vector<Turns> turns;
  for (std::uint16_t i = 0; i < 3; ++i) turns.push_back(lasers[i].turns(5, i, 200));
  const auto aligned = align(turns, SimulatedPlate{}.readings(5, 200));
  ASSERT_GT(aligned.stretches.size(), 2u);
  double last = -HUGE_VAL;
  for (const auto& stretch : aligned.stretches) {
    for (const auto& scan : stretch.scans) {
      EXPECT_GE(scan.time.front(), last);
      last = scan.time.front();
    }
  }
}

TEST(ClockAligner, IsNotLedAstrayByTwoMinutesOfLateTelegrams) {
  SimulatedLaser laser;
  laser.beams = 2;
  int sent = 0;
  laser.delays = [=](Random& random) mutable {  // from 100 s to 200 s every telegram is late by 2 ms and more
    const double t = 0.0201145 * sent++;
    return (t > 100 && t < 200 ? 2e-3 : 0) + exponential_delays(1e-4)(random);
  };
  const auto turns = laser.turns(2, 0, 600);
  const auto aligned = align({turns}, SimulatedPlate{}.readings(2, 600));
  const auto errors = beam_time_errors(aligned, 0, laser, turns);
  // A drift of 200 ppm/h, which is allowed for, is 28 us over 45 s to either side.
  EXPECT_LT(errors.worst, 80e-6);
}

TEST(ClockAligner, WidensItsWindowWhereDelaysAreRough) {
  SimulatedLaser laser;
  laser.beams = 2;
  laser.clock.skew = [](double) { return -70e-6; };
  laser.delays = gamma_delays(4, 5e-3);  // as over a wireless network: 20 ms, and never near the least
  const auto turns = laser.turns(1, 0, 1000);
  const auto readings = SimulatedPlate{}.readings(1, 1000);
  const auto automatic = align({turns}, readings);
  const auto fixed = align({turns}, readings, {.window = 60});
  EXPECT_LE(automatic.stretches.size(), 5u);
  EXPECT_GE(fixed.stretches.size(), 15u);
  const auto errors = beam_time_errors(automatic, 0, laser, turns);
  // Of 12000 delays in a window the least is some 0.7 ms; that the line has it everywhere is what counts.
  EXPECT_LT(errors.median, 2e-3);
  EXPECT_LT(errors.worst, 4e-3);
  EXPECT_NEAR(automatic.report.devices[0].clock.skew_ppm(), -70, 2);
}

TEST(ClockAligner, GivesWayToAStepOfTheLatencyOnlyAsFastAsAClockCouldDrift) {
  SimulatedLaser laser;
  laser.beams = 2;
  int sent = 0;
  laser.delays = [=](Random& random) mutable {  // from 300 s on every telegram is later by half a millisecond
    return (0.0201145 * sent++ > 300 ? 0.5e-3 : 0) + exponential_delays(1e-4)(random);
  };
  const auto turns = laser.turns(2, 0, 600);
  const auto aligned = align({turns}, SimulatedPlate{}.readings(2, 600));
  const auto scans = aligned.of_laser(0);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double late = scans[i]->time[0] - (kStart + turns[i].begin + laser.minimum_delay);
    if (turns[i].begin < 270) {
      EXPECT_LT(std::abs(late), 15e-6);
    }
    EXPECT_GT(late, -15e-6);
    EXPECT_LT(late, 0.52e-3);
  }
}

TEST(ClockAligner, CountsLostTelegramsAndStillKnowsTheMirrorsPeriod) {
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

TEST(ClockAligner, CutsAtAResetOfALaserAndGoesOnAfterIt) {
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

TEST(ClockAligner, LeavesOutWhatComesAfterThePlateHasLostItsZero) {
  SimulatedPlate plate;
  plate.clock.reset_at = 6;
  plate.forgets_count_at_reset = true;
  const auto aligned = align({SimulatedLaser{}.turns(6, 0, 10)}, plate.readings(6, 10));
  EXPECT_NEAR(static_cast<double>(aligned.report.counts.at("plate: readings after its zero was lost")), 2000,
              1);
  EXPECT_NEAR(aligned.stretches.front().plate.end(), kStart + 6, 0.01);
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("lost its zero")));
}

TEST(ClockAligner, GoesOnWhereOnlyThePlatesClockWasReset) {
  SimulatedPlate plate;
  plate.clock.reset_at = 6;
  const auto aligned = align({SimulatedLaser{}.turns(6, 0, 10)}, plate.readings(6, 10));
  EXPECT_EQ(aligned.report.devices[1].resets, 1u);
  EXPECT_EQ(aligned.report.counts.at("plate: readings after its zero was lost"), 0u);
  const auto& trajectory = aligned.stretches.front().plate;
  const double before = trajectory.at(kStart + 5)->angle;
  EXPECT_NEAR(trajectory.at(kStart + 8)->angle - before, 3 * 2 * std::numbers::pi, 1e-3);
}

TEST(ClockAligner, LeavesOutAnAngleThatThePlateCannotHaveReached) {
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

TEST(ClockAligner, DoesNotHoldTheRestAgainstADamagedFirstReading) {
  auto readings = SimulatedPlate{}.readings(7, 4);
  readings[0].count ^= 0x400000;
  const auto aligned = align({SimulatedLaser{}.turns(7, 0, 4)}, readings);
  EXPECT_EQ(aligned.stretches.front().plate.size(), readings.size() - 5);  // it takes five to outvote it
  EXPECT_THAT(aligned.report.warnings, ::testing::IsEmpty());
}

TEST(ClockAligner, LeavesOutWhatComesAfterTheCountHasJumped) {
  auto readings = SimulatedPlate{}.readings(7, 10);
  for (std::size_t i = 3000; i < readings.size(); ++i) readings[i].count += 5000;
  const auto aligned = align({SimulatedLaser{}.turns(7, 0, 10)}, readings);
  EXPECT_EQ(aligned.stretches.front().plate.size(), 3000u);
  EXPECT_THAT(aligned.report.warnings, Contains(HasSubstr("lost its zero")));
}

TEST(ClockAligner, LeavesOutADamagedStampInsteadOfCuttingThere) {
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

TEST(ClockAligner, SetsAsideWhatComesTwice) {
  auto turns = SimulatedLaser{}.turns(9, 0, 3);
  turns.insert(turns.begin() + 50, turns[49]);
  const auto aligned = align({turns}, SimulatedPlate{}.readings(9, 3));
  EXPECT_EQ(aligned.report.devices[0].repeated, 1u);
  EXPECT_EQ(aligned.of_laser(0).size(), turns.size() - 1);
}

TEST(ClockAligner, NamesThePeriodOffsetThatAFirmwareNeeds) {
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

TEST(ClockAligner, NamesADeviceThatIsMissing) {
  const auto aligned = align({SimulatedLaser{}.turns(1, 0, 2), {}}, SimulatedPlate{}.readings(1, 2));
  EXPECT_THAT(aligned.report.warnings, Contains("laser2: nothing came from it"));
  EXPECT_THROW(align({SimulatedLaser{}.turns(1, 0, 2)}, {}), Error);
  EXPECT_THROW(align({{}}, SimulatedPlate{}.readings(1, 2)), Error);
}

TEST(ClockAligner, SurvivesNonsense) {
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

TEST(ClockAligner, WithReceiptTimesIsAsWrongAsTheDelaysAre) {
  SimulatedLaser laser;
  laser.delays = exponential_delays(1e-3);
  const auto turns = laser.turns(1, 0, 10);
  const auto aligned = align({turns}, SimulatedPlate{}.readings(1, 10), {.source = TimeSource::receipt});
  EXPECT_NEAR(beam_time_errors(aligned, 0, laser, turns).median, 1e-3 * std::log(2), 0.2e-3);
}

TEST(ClockAligner, ByTheLinearProgrammeGivesTheSameTimes) {
  const auto lasers = three_lasers(11);
  const std::vector<Turns> turns = {lasers[0].turns(11, 0, 200)};
  const auto readings = SimulatedPlate{}.readings(11, 200);
  const auto hull = align(turns, readings);
  const auto programme = align(turns, readings, {.find = line_by_linear_program});
  ASSERT_EQ(hull.stretches.size(), programme.stretches.size());
  for (std::size_t s = 0; s < hull.stretches.size(); ++s) {
    ASSERT_EQ(hull.stretches[s].scans.size(), programme.stretches[s].scans.size());
    for (std::size_t i = 0; i < hull.stretches[s].scans.size(); ++i) {
      EXPECT_NEAR(hull.stretches[s].scans[i].time[0], programme.stretches[s].scans[i].time[0], 1e-12);
    }
  }
}

}  // namespace
}  // namespace crisp
