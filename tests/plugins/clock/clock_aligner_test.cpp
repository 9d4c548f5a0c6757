// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "tests/plugins/clock/aligned.hpp"

namespace crisp {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
      EXPECT_NEAR(aligned.report.devices[i].clock->skew_ppm(), 1e6 * lasers[i].clock.skew(0), 2);
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

TEST(ClockAligner, PlacesTheCountsInALasersTelegramsAtItsScansStamps) {
  SimulatedLaser laser;
  laser.clock.skew = [](double) { return 120e-6; };
  const auto angle = [](double t) { return 3 * std::sin(1.1 * t) - 2 * t; };
  const auto turns = laser.turns(4, 0, 30);
  std::vector<PlateReading> readings;  // one a scan, on the laser's clock, sent 23 ms after its stamp
  for (const auto& turn : turns) {
    const Scan& scan = turn.scan;
    readings.push_back(
        {.sequence = scan.telegram_counter,
         .device_us = scan.scan_time_us,
         .count =
             static_cast<std::uint32_t>(std::llround(angle(turn.begin) * 16384 / (2 * std::numbers::pi))),
         .receipt_ns = scan.receipt_ns,
         .handover_us = static_cast<std::int32_t>(scan.transmission_time_us - scan.scan_time_us)});
  }
  for (const auto source : {TimeSource::clock, TimeSource::receipt}) {
    const auto aligned = align({turns}, readings, {.source = source});
    const double delay =
        laser.minimum_delay + (source == TimeSource::receipt ? 1e-4 : 0);  // and the mean one
    double worst = 0;
    for (const auto& turn : turns) {
      if (turn.begin < 1 || turn.begin > 29) continue;
      const auto state = aligned.stretches.front().plate.at(kStart + turn.begin + delay);
      ASSERT_TRUE(state);
      worst =
          std::max(worst, std::abs(std::remainder(state->angle - angle(turn.begin), 2 * std::numbers::pi)));
    }
    // Half a step is 0.2 mrad. By receipt, delays of 100 us on the mean and a millisecond at most move the
    // plate of 5.3 rad/s by as many mrad.
    EXPECT_LT(worst, source == TimeSource::clock ? 0.4e-3 : 6e-3);
  }
}

TEST(ClockAligner, UsesTheRigsChoiceOfEchoesAndCountsWhatIsNotTheFirst) {
  SimulatedLaser laser;
  laser.beams = 3;
  auto turns = laser.turns(6, 0, 2);
  for (auto& turn : turns) turn.scan.echoes = {{.ranges = {1, 0, 0}}, {.ranges = {4, 5, 0}}};
  const auto ranges = [&](EchoChoice choice) {
    Rig rig = default_rig();
    rig.lasers[0].echo = choice;
    const auto aligned = align({turns}, SimulatedPlate{}.readings(6, 2), {}, rig);
    EXPECT_EQ(aligned.report.counts.at("laser1: beams with a later echo only"), turns.size());
    EXPECT_EQ(aligned.report.counts.at("laser1: beams without echo"), turns.size());
    EXPECT_EQ(aligned.report.counts.at("laser1: echoes that the rig's choice leaves out"),
              choice == EchoChoice::all ? 0 : turns.size());
    return aligned.of_laser(0).front()->range;
  };
  EXPECT_THAT(ranges(EchoChoice::first), ElementsAre(1, 5));
  EXPECT_THAT(ranges(EchoChoice::last), ElementsAre(4, 5));
  EXPECT_THAT(ranges(EchoChoice::all), ElementsAre(1, 4, 5));
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

TEST(ClockAligner, IsRobustToTwoMinutesOfLateTelegrams) {
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
  // The least of 12000 delays in a window is some 0.7 ms; its constancy is what counts.
  EXPECT_LT(errors.median, 2e-3);
  EXPECT_LT(errors.worst, 4e-3);
  EXPECT_NEAR(automatic.report.devices[0].clock->skew_ppm(), -70, 2);
}

/// Exponential delays of 0.1 ms, and `by` more [s] from the telegram on that is sent `at` [s].
Delays delays_with_step(double at, double by) {
  int sent = 0;
  return [=](Random& random) mutable {
    return (0.0201145 * sent++ > at ? by : 0) + exponential_delays(1e-4)(random);
  };
}

TEST(ClockAligner, TakesOutAStepOfTheShortestDelayWhereverItIs) {
  for (const double by : {0.5e-3, -0.5e-3, 5e-3, -5e-3}) {
    for (const double at : {1.0, 3.0, 5.0, 8.0}) {
      SimulatedLaser laser;
      laser.beams = 2;
      laser.delays = delays_with_step(at, by);
      laser.minimum_delay = 6e-3;
      const auto turns = laser.turns(2, 0, 10);
      const auto aligned = align({turns}, SimulatedPlate{}.readings(2, 10));
      if (at < 5) laser.minimum_delay += by;  // what lasts longer is what is usual
      // The lower of two minima of some hundred delays of 0.1 ms, on either side of the step.
      EXPECT_LT(beam_time_errors(aligned, 0, laser, turns).worst, 20e-6) << by << " at " << at;
      const DeviceReport& device = aligned.report.devices[0];
      ASSERT_EQ(device.delay_steps.size(), 1u) << by << " at " << at;
      EXPECT_NEAR(device.delay_steps[0].by, by, 15e-6);
      EXPECT_NEAR(device.delay_steps[0].at, kStart + at, 0.1);
      EXPECT_LT(std::abs(device.clock->skew_ppm()), 3 * 1e6 * device.clock->skew_std_error);
      EXPECT_THAT(device.clock_steps, IsEmpty());
      EXPECT_THAT(aligned.report.caveats, IsEmpty());
      EXPECT_THAT(aligned.report.warnings,
                  ElementsAre(HasSubstr("laser1: its shortest delay changed 1 time")));
    }
  }
}

TEST(ClockAligner, TakesOutAStepOfTheShortestDelayInALongRecording) {
  for (const double at : {290.0, 300.0, 310.0, 330.0}) {  // about the border of two windows
    SimulatedLaser laser;
    laser.beams = 2;
    laser.delays = delays_with_step(at, 0.5e-3);
    const auto turns = laser.turns(2, 0, 600);
    const auto aligned = align({turns}, SimulatedPlate{}.readings(2, 600));
    EXPECT_LT(beam_time_errors(aligned, 0, laser, turns).worst, 15e-6) << at;
    EXPECT_EQ(aligned.report.devices[0].delay_steps.size(), 1u) << at;
  }
}

TEST(ClockAligner, TakesOutAStepOfAClock) {
  for (const double by : {0.5e-3, -0.5e-3, 5e-3, -5e-3, 50e-3, -50e-3}) {
    for (const double at : {0.5, 3.0, 9.5}) {
      SimulatedLaser laser;
      laser.beams = 2;
      laser.period = [](double t) { return 0.02 * (1.004 + 2e-3 * std::sin(1.7 * t)); };
      laser.stamp_jitter = [](Random& random) { return std::normal_distribution<>(0, 20e-6)(random); };
      laser.clock.step_at = at;
      laser.clock.step_by = by;
      SimulatedPlate plate;
      plate.clock.step_at = at + 0.1;
      plate.clock.step_by = -by;
      const auto turns = laser.turns(2, 0, 10);
      const auto aligned = align({turns}, plate.readings(2, 10));
      // A jump is determined as well as the predicted time of its turn: 20 us of jitter on either side.
      const std::size_t lost = by < -0.02 ? 3 : 0;  // the clock is not ascending for this long
      const auto scans = aligned.of_laser(0);
      ASSERT_GE(scans.size() + lost, turns.size());
      for (const Measurements* scan : scans) {
        const auto turn = std::ranges::find_if(turns, [&](const auto& turn) {
          return std::abs(kStart + turn.begin + laser.minimum_delay - scan->time[0]) < 5e-3;
        });
        ASSERT_NE(turn, turns.end()) << by << " at " << at << ": a beam at " << scan->time[0];
        EXPECT_NEAR(scan->time[0], kStart + turn->begin + laser.minimum_delay, 0.15e-3) << by << " at " << at;
      }
      for (const std::size_t device : {0u, 1u}) {
        const DeviceReport& report = aligned.report.devices[device];
        ASSERT_EQ(report.clock_steps.size(), 1u) << by << " at " << at << ": " << report.device;
        EXPECT_NEAR(report.clock_steps[0].by, device == 0 ? by : -by, 0.12e-3);
        EXPECT_LT(std::abs(report.clock->skew_ppm()), 40) << by << " at " << at;
        EXPECT_THAT(report.delay_steps, IsEmpty()) << by << " at " << at << ": " << report.device;
      }
      EXPECT_THAT(aligned.report.caveats, IsEmpty());
    }
  }
}

TEST(ClockAligner, MarksAClockWithFewTelegramsUntrusted) {
  const auto report_with = [](double delay) {
    SimulatedLaser laser;
    laser.beams = 2;
    laser.delays = gamma_delays(4, delay);
    return align({laser.turns(2, 0, 10)}, SimulatedPlate{}.readings(2, 10)).report;
  };
  EXPECT_THAT(report_with(1e-4).warnings, IsEmpty());
  const AlignmentReport warned = report_with(1e-3);
  EXPECT_THAT(warned.warnings, ElementsAre(HasSubstr("laser1: its clock is determined to 0.")));
  EXPECT_THAT(warned.caveats, IsEmpty());
  EXPECT_THAT(report_with(1e-2).caveats, ElementsAre(HasSubstr("laser1: its clock is determined to")));
}

TEST(ClockAligner, WithReceiptTimesIsAsWrongAsTheDelaysAre) {
  SimulatedLaser laser;
  laser.delays = exponential_delays(1e-3);
  const auto turns = laser.turns(1, 0, 10);
  const auto aligned = align({turns}, SimulatedPlate{}.readings(1, 10), {.source = TimeSource::receipt});
  EXPECT_NEAR(beam_time_errors(aligned, 0, laser, turns).median, 1e-3 * std::log(2), 0.2e-3);
}

/// Twenty seconds of which some in the middle were not recorded.
class PausedRecording : public ::testing::Test {
 protected:
  static bool is_paused(double t) { return t >= 7 && t < 14; }
  PausedRecording() {
    laser_.is_lost = plate_.is_lost = is_paused;
    laser_.beams = 9;
    // The clock's rate changes by far more than a line would stand, within a silence.
    laser_.clock.skew = [](double t) { return t < 10 ? -30e-6 : 120e-6; };
  }
  Aligned aligned() const { return align({laser_.turns(1, 0, 20)}, plate_.readings(1, 20)); }

  SimulatedLaser laser_;
  SimulatedPlate plate_;
};

TEST_F(PausedRecording, EachPartHasClocksOfItsOwn) {
  const auto turns = laser_.turns(1, 0, 20);
  const auto result = aligned();
  ASSERT_EQ(result.stretches.size(), 2U);
  const auto errors = beam_time_errors(result, 0, laser_, turns);
  EXPECT_LT(errors.median, 6e-6);
  EXPECT_LT(errors.worst, 25e-6);
  ASSERT_EQ(result.report.devices.size(), 4U) << "laser and plate, twice";
  EXPECT_NEAR(result.report.devices[0].clock->skew_ppm(), -30, 3);
  EXPECT_NEAR(result.report.devices[2].clock->skew_ppm(), 120, 3);
  for (const auto& device : result.report.devices) EXPECT_EQ(device.lost, 0U) << device.device;
}

TEST_F(PausedRecording, AnEncoderThatWentOnCountingKeepsItsZero) {
  const auto result = aligned();
  EXPECT_TRUE(result.stretches.at(1).plate.new_zeros().empty());
  const auto before = result.stretches[0].plate.at(kStart + 5);
  const auto after = result.stretches[1].plate.at(kStart + 17);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->angle - before->angle, 12 * 2 * std::numbers::pi, 0.01);
}

TEST_F(PausedRecording, AnEncoderThatBeganAnewHasANewZero) {
  plate_.clock.reset_at = 10;
  plate_.forgets_count_at_reset = true;
  const auto result = aligned();
  ASSERT_EQ(result.stretches.size(), 2U);
  EXPECT_THAT(result.stretches[1].plate.new_zeros(), ::testing::SizeIs(1));
  EXPECT_EQ(result.report.counts.at("plate: readings after its zero was lost"), 0U);
  EXPECT_FALSE(result.stretches[1].scans.empty());
}

TEST_F(PausedRecording, APartWithoutThePlateIsCountedAndTheOtherUsed) {
  plate_.is_lost = [](double t) { return t < 14; };
  const auto result = aligned();
  EXPECT_EQ(result.stretches.size(), 1U);
  EXPECT_EQ(result.report.counts.at("recordings without any scan, or without two encoder readings"), 1U);
  EXPECT_THAT(result.report.warnings,
              ::testing::Contains(::testing::HasSubstr("plate: no data of it in one")));
}

}  // namespace
}  // namespace crisp
