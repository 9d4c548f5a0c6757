// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/recording.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <crisp/error.hpp>

#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;
using namespace crisp::wire;

/// Clocks that run true and start at zero, delays without jitter, a mirror at its nominal rate.
RecordingSettings plain_settings() {
  RecordingSettings settings;
  settings.scanner.duration = 1;
  settings.scanner.mirror = {.slowest = 0, .wander = 0};
  settings.laser_link = {.minimum = 2e-3, .jitter = 0, .stall_rate = 0};
  settings.plate_link = {.minimum = 5e-4, .jitter = 0, .stall_rate = 0};
  settings.telegrams.handover_jitter = 0;
  settings.clock_overrides.assign(4, DeviceClock{.start = 100});
  return settings;
}

TEST(DrawDevices, GivesEachLaserItsEtaByHandWorkedDelays) {
  RecordingSettings settings = plain_settings();
  settings.scanner.truth.lasers[0].eta.value = -0.010;
  settings.scanner.truth.lasers[1].eta.value = 0.007;
  settings.stamp_lags = {0, 0, 0.001};
  // Laser 2 needs the plate to be 7 ms later than itself: 2 ms + 7 ms. Laser 1 is 10 ms later than the plate.
  // Laser 3 has η = 0: its stamp lags by 1 ms, so its delay is 1 ms shorter than the plate's.
  const auto truth = draw_devices(settings);
  EXPECT_NEAR(truth.plate.minimum_delay, 0.009, 1e-12);
  EXPECT_NEAR(truth.lasers[0].minimum_delay, 0.019, 1e-12);
  EXPECT_NEAR(truth.lasers[1].minimum_delay, 0.002, 1e-12);
  EXPECT_NEAR(truth.lasers[2].minimum_delay, 0.008, 1e-12);
}

TEST(RecordingSimulator, PutsTheCountOfAWiredEncoderIntoItsLasersTelegrams) {
  RecordingSettings settings = plain_settings();
  settings.scanner.rig.plate.encoder_of = 1;
  settings.scanner.truth.lasers[1].eta.value = 0.004;
  const auto recording = simulate_recording(settings, office());
  const RecordingSimulator simulator(settings, office());
  std::size_t counted = 0;
  for (const Scan& scan : recording.scans) {
    ASSERT_EQ(scan.encoders.size(), scan.laser == 1 ? 1U : 0U);
    if (scan.laser != 1) continue;
    // Its clock shows 100 s at hub time 0, and the plate's delay exceeds its own by eta.
    const double latched = 1e-6 * scan.scan_time_us - 100 - 0.004;
    const double steps = simulator.motion().at(latched)->angle / settings.scanner.rig.plate.angle_per_count();
    EXPECT_NEAR(static_cast<double>(static_cast<std::int32_t>(scan.encoders[0].position)), steps, 0.55);
    ++counted;
  }
  EXPECT_EQ(recording.readings.size(), counted) << "the plate sends none of its own";
  EXPECT_GT(counted, 40U);
}

TEST(DrawDevices, DrawsClocksWithinTheirBounds) {
  RecordingSettings settings;
  settings.clocks.drift = 1e-9;
  std::set<double> skews;
  for (settings.scanner.seed = 1; settings.scanner.seed <= 50; ++settings.scanner.seed) {
    const auto truth = draw_devices(settings);
    for (const auto& clock : {truth.lasers[0].clock, truth.lasers[1].clock, truth.plate.clock}) {
      EXPECT_LE(std::abs(clock.skew), 250e-6);
      EXPECT_LE(std::abs(clock.drift), 1e-9);
      EXPECT_GE(clock.start, 0);
      EXPECT_LT(clock.start, 4294.967296);
      skews.insert(clock.skew);
    }
  }
  EXPECT_EQ(skews.size(), 150U);
  EXPECT_LT(*skews.begin(), -200e-6);
  EXPECT_GT(*skews.rbegin(), 200e-6);
}

TEST(SimulateRecording, StampsScansByTheRigsDevice) {
  for (const int periods : {0, -1}) {
    RecordingSettings settings = plain_settings();
    for (auto& laser : settings.scanner.rig.lasers) laser.period_offset = periods;
    const auto recording = simulate_recording(settings, office());
    ASSERT_EQ(recording.scans.size(), 150U);
    for (const auto& scan : recording.scans) {
      // Handed over 3.1 ms after the turn of 20 ms; a stamp that is a period late leaves 3.1 ms only.
      const auto wait = static_cast<double>(scan.transmission_time_us - scan.scan_time_us);
      ASSERT_NEAR(wait, periods == 0 ? 23'100 : 3'100, 1);
    }
  }
}

TEST(SimulateRecording, ReceivesWhatWasSentAfterTheMinimumDelay) {
  const auto recording = simulate_recording(plain_settings(), office());
  const std::int64_t start = RecordingSettings{}.start_ns;
  for (const auto& scan : recording.scans) {
    const double hub = 1e-9 * static_cast<double>(scan.receipt_ns - start);
    ASSERT_NEAR(hub - (1e-6 * scan.transmission_time_us - 100),
                recording.truth.lasers[scan.laser].minimum_delay, 1.1e-6);
  }
  ASSERT_NEAR(static_cast<double>(recording.readings.size()), 1.2 * 500, 2);
  for (const auto& reading : recording.readings) {
    const double hub = 1e-9 * static_cast<double>(reading.receipt_ns - start);
    ASSERT_NEAR(hub - (1e-6 * reading.device_us - 100), recording.truth.plate.minimum_delay, 1.1e-6);
  }
}

/// φ at a hub time by a straight line between the readings' hub times (receipts, since nothing jitters).
double plate_angle(const std::vector<PlateReading>& readings, std::int64_t hub_ns) {
  const auto next = std::lower_bound(readings.begin() + 1, readings.end() - 1, hub_ns,
                                     [](const auto& r, std::int64_t t) { return r.receipt_ns < t; });
  const auto& a = *std::prev(next);
  const double share =
      static_cast<double>(hub_ns - a.receipt_ns) / static_cast<double>(next->receipt_ns - a.receipt_ns);
  const double counts = a.count + share * (static_cast<double>(next->count) - a.count);
  return counts * 2 * std::numbers::pi / 16384;
}

/// Mean distance to the true surfaces of the points that equations (2) and (3) make of a recording, written
/// out here by hand, with η off by `eta_error`.
double mean_distance(const SimulatedRecording& recording, const Scene& scene, double eta_error) {
  const RayCaster surfaces(scene);
  double sum = 0;
  int n = 0;
  for (const auto& scan : recording.scans) {
    const auto& laser = recording.truth.calibration.lasers[scan.laser];
    const double hub_minus_device =
        static_cast<double>(scan.receipt_ns - recording.scans.front().receipt_ns) -
        1e3 * scan.transmission_time_us;
    for (std::size_t k = 0; k < scan.echoes[0].ranges.size(); k += 20) {
      const double r = scan.echoes[0].ranges[k];
      if (r == 0) continue;
      const double theta = scan.start_angle + static_cast<double>(k) * scan.angle_step - 45 * kDegree;
      const double fired = 1e3 * scan.scan_time_us + static_cast<double>(k) / 720 * 20e6 + hub_minus_device;
      const auto at = recording.scans.front().receipt_ns +
                      static_cast<std::int64_t>(fired + 1e9 * (laser.eta.value + eta_error));
      const double phi = plate_angle(recording.readings, at);
      const Eigen::Vector3d in_plane(r * std::cos(theta), r * std::sin(theta), 0);
      const Eigen::Vector3d mounted = Eigen::AngleAxisd(laser.alpha.value, Eigen::Vector3d::UnitZ()) *
                                      (Eigen::AngleAxisd(90 * kDegree, Eigen::Vector3d::UnitY()) * in_plane);
      const Eigen::Vector3d point = Eigen::AngleAxisd(phi + laser.lambda.value, Eigen::Vector3d::UnitZ()) *
                                    (mounted + Eigen::Vector3d(laser.tau.value, 0, 0));
      sum += surfaces.distance(point);
      ++n;
    }
  }
  return sum / n;
}

TEST(SimulateRecording, GivesPointsOnTheSurfacesWithTheTrueEtaOnly) {
  RecordingSettings settings = plain_settings();
  settings.scanner.range = {.sigma = 0};
  settings.scanner.motion = {.kind = MotionKind::constant, .max_rate = 1.5};
  settings.scanner.truth.lasers[0].eta.value = -0.012;
  settings.scanner.truth.lasers[1].eta.value = 0.020;
  settings.scanner.truth.lasers[1].alpha.value = 2 * kDegree;
  settings.stamp_lags = {0, 0.004, -0.003};
  const Scene scene = office();
  const auto recording = simulate_recording(settings, scene);
  // Left over: 1 mm steps, half a count (0.011°) and a microsecond: below a millimetre.
  EXPECT_LT(mean_distance(recording, scene, 0), 1e-3);
  // 1 ms is 0.54° here: centimetres at some metres, where walls are oblique.
  EXPECT_GT(mean_distance(recording, scene, 1e-3), 3e-3);
  EXPECT_GT(mean_distance(recording, scene, -1e-3), 3e-3);
}

TEST(SimulateRecording, ComesInTheOrderOfReceiptAndCountsItsTelegrams) {
  RecordingSettings settings;
  settings.scanner.duration = 2;
  settings.laser_link.stall_rate = 2;
  settings.laser_link.stall_time = 0.05;
  RecordingSimulator simulator(settings, office());
  std::int64_t last = 0;
  std::array<std::optional<ScanData>, 3> before;
  while (const auto event = simulator.next()) {
    ASSERT_GE(receipt_ns(*event), last);
    last = receipt_ns(*event);
    const auto* telegram = std::get_if<LaserTelegram>(&*event);
    if (!telegram) continue;
    auto& previous = before[telegram->laser];
    if (previous) {
      ASSERT_EQ(telegram->data.scan_counter, static_cast<std::uint16_t>(previous->scan_counter + 1));
      ASSERT_EQ(telegram->data.telegram_counter, static_cast<std::uint16_t>(previous->telegram_counter + 1));
      ASSERT_NEAR(telegram->data.scan_time_us - previous->scan_time_us, 20'080, 100);
    }
    previous = telegram->data;
  }
  EXPECT_NEAR(simulator.progress(), 1, 1e-9);
}

TEST(SimulateRecording, HasDeviceClocksWithTheSkewsOfItsTruth) {
  RecordingSettings settings;
  settings.scanner.duration = 5;
  settings.scanner.field.last = -44 * kDegree;  // few beams: only the stamps matter here
  settings.laser_link = {.minimum = 1e-3, .jitter = 0, .stall_rate = 0};
  settings.telegrams.handover_jitter = 0;
  const auto recording = simulate_recording(settings, office());
  for (std::uint16_t laser = 0; laser < 3; ++laser) {
    std::vector<Scan> own;
    for (const auto& scan : recording.scans) {
      if (scan.laser == laser) own.push_back(scan);
    }
    const double hub = 1e-9 * static_cast<double>(own.back().receipt_ns - own.front().receipt_ns);
    const double device = 1e-6 * (own.back().transmission_time_us - own.front().transmission_time_us);
    EXPECT_NEAR(hub / device - 1, recording.truth.lasers[laser].clock.skew, 1e-6);  // ±1 µs in 5 s: 0.4 ppm
  }
}

TEST(SimulateRecording, LosesTheRequestedShare) {
  RecordingSettings settings = plain_settings();
  settings.scanner.duration = 4;
  settings.scanner.field.last = -44 * kDegree;
  settings.faults.lost_scans = 0.1;
  settings.faults.lost_readings = 0.02;
  settings.faults.silences = {{.device = "laser2", .begin = 1, .duration = 1},
                              {.device = "plate", .begin = 3, .duration = 2}};
  const auto recording = simulate_recording(settings, office());
  std::array<int, 3> scans{};
  for (const auto& scan : recording.scans) ++scans[scan.laser];
  EXPECT_NEAR(scans[0], 200 * 0.9, 4 * std::sqrt(200 * 0.09));
  EXPECT_NEAR(scans[1], 150 * 0.9, 4 * std::sqrt(150 * 0.09));
  EXPECT_NEAR(static_cast<double>(recording.readings.size()), 1550 * 0.98, 4 * std::sqrt(1550 * 0.02));
  std::int64_t widest = 0;
  for (std::size_t i = 1; i < recording.readings.size(); ++i) {
    const auto step =
        static_cast<std::uint16_t>(recording.readings[i].sequence - recording.readings[i - 1].sequence);
    const auto gap = recording.readings[i].receipt_ns - recording.readings[i - 1].receipt_ns;
    ASSERT_NEAR(static_cast<double>(gap), step * 2e6, 2e3) << "the sequence counts the missing ones";
    widest = std::max(widest, gap);
  }
  EXPECT_LT(widest, 30'000'000) << "silent to the end, not in between";
}

TEST(SimulateRecording, RestartsADeviceWithClockAndCountersAtZero) {
  RecordingSettings settings = plain_settings();
  settings.scanner.duration = 2;
  settings.scanner.field.last = -44 * kDegree;
  settings.faults.restarts = {{.device = "laser1", .time = 1}, {.device = "plate", .time = 1.5}};
  const auto recording = simulate_recording(settings, office());
  int restarted = 0;
  for (const auto& scan : recording.scans) {
    const bool after = scan.transmission_time_us < 50'000'000;  // the clocks started at 100 s
    if (after) {
      EXPECT_EQ(scan.laser, 0);
      EXPECT_LT(scan.scan_counter, 60);
      EXPECT_LT(scan.transmission_time_us - scan.scan_time_us, 24'000U) << "both stamps are of one clock";
      ++restarted;
    }
  }
  EXPECT_NEAR(restarted, 49, 2);
  EXPECT_NEAR(recording.readings.back().device_us, 600'000, 3'000);
  EXPECT_NEAR(recording.readings.back().sequence, 300, 2);
}

TEST(SimulateRecording, IsTheSameForTheSameSeedOnly) {
  RecordingSettings settings;
  settings.scanner.duration = 0.3;
  const auto one = simulate_recording(settings, office());
  const auto same = simulate_recording(settings, office());
  settings.scanner.seed = 2;
  const auto other = simulate_recording(settings, office());
  const auto stamps = [](const SimulatedRecording& recording) {
    std::vector<std::int64_t> all;
    for (const auto& scan : recording.scans) all.push_back(scan.receipt_ns);
    for (const auto& reading : recording.readings) all.push_back(reading.receipt_ns + reading.count);
    return all;
  };
  EXPECT_EQ(stamps(one), stamps(same));
  EXPECT_EQ(one.scans.back().echoes[0].ranges, same.scans.back().echoes[0].ranges);
  EXPECT_NE(stamps(one), stamps(other));
}

TEST(SimulateRecording, RefusesWhatTelegramsCannotHold) {
  const auto with = [](auto change) {
    RecordingSettings settings;
    settings.scanner.duration = 0.1;
    change(settings);
    return settings;
  };
  const Scene scene = office();
  EXPECT_THROW(simulate_recording(with([](auto& s) { s.scanner.range.max_distance = 80; }), scene), Error);
  EXPECT_THROW(simulate_recording(with([](auto& s) { s.scanner.beams = {3}; }), scene), Error);
  EXPECT_THROW(simulate_recording(with([](auto& s) { s.scanner.field.step = 0.00777; }), scene), Error);
  EXPECT_THROW(simulate_recording(with([](auto& s) { s.stamp_lags = {1}; }), scene), Error);
  EXPECT_THROW(simulate_recording(with([](auto& s) { s.faults.silences = {{.device = "laser9"}}; }), scene),
               Error);
  EXPECT_NO_THROW(simulate_recording(with([](auto& s) { s.scanner.field.step = kDegree / 3; }), scene));
}

}  // namespace
}  // namespace crisp
