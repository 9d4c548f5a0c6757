// SPDX-License-Identifier: BSD-3-Clause
// What was simulated, read back by the capture's reader and put together by clock alignment and sensor model.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include <crisp/capture_reader.hpp>
#include <crisp/clock_aligner.hpp>
#include <crisp/sensor_model.hpp>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/nominal_errors.hpp"
#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/recorded_capture.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;
namespace fs = std::filesystem;

std::vector<HubItem> read_all(CaptureReader& reader) {
  std::vector<HubItem> items;
  while (auto item = reader.next()) items.push_back(std::move(*item));
  return items;
}

class RoundTrip : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    file_ = fs::path(testing::TempDir()) / (std::string("crisp_round_trip_") + test->name() + ".pcap");
    settings_.scanner.duration = 1;
  }
  void TearDown() override { fs::remove(file_); }

  std::vector<HubEvent> write(const WireFaults& faults = {}) {
    RecordingSimulator simulator(settings_, office());
    RecordedCapture capture(file_, settings_, simulator.truth(), faults);
    std::vector<HubEvent> events;
    while (auto event = simulator.next()) {
      capture.write(*event);
      events.push_back(std::move(*event));
    }
    capture.close();
    faults_ = capture.faults();
    return events;
  }

  fs::path file_;
  RecordingSettings settings_;
  FaultyWire::Counts faults_;
};

TEST_F(RoundTrip, ACaptureGivesBackEveryScanAndReading) {
  const auto events = write();
  CaptureReader reader(file_, settings_.scanner.rig);
  const auto items = read_all(reader);
  ASSERT_EQ(items.size(), events.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (const auto* telegram = std::get_if<LaserTelegram>(&events[i])) {
      const Scan expected = to_scan(*telegram);
      const Scan& scan = *std::get<std::shared_ptr<const Scan>>(items[i]);
      ASSERT_EQ(scan.laser, expected.laser);
      ASSERT_EQ(scan.receipt_ns, expected.receipt_ns);
      ASSERT_EQ(scan.scan_counter, expected.scan_counter);
      ASSERT_EQ(scan.scan_time_us, expected.scan_time_us);
      ASSERT_EQ(scan.echoes[0].ranges, expected.echoes[0].ranges);
      ASSERT_EQ(scan.echoes[0].remissions, expected.echoes[0].remissions);
      ASSERT_EQ(scan.start_angle, expected.start_angle);
      ASSERT_EQ(scan.angle_step, expected.angle_step);
    } else {
      const auto& expected = std::get<PlateReading>(events[i]);
      const auto& reading = std::get<PlateReading>(items[i]);
      ASSERT_EQ(reading.count, expected.count);
      ASSERT_EQ(reading.device_us, expected.device_us);
      ASSERT_EQ(reading.receipt_ns, expected.receipt_ns);
    }
  }
  const auto statistics = reader.statistics();
  EXPECT_TRUE(statistics.losses.all().empty());
  for (const auto& device : statistics.devices) EXPECT_TRUE(device.losses.all().empty()) << device.name;
}

TEST_F(RoundTrip, AFaultyWireLosesTelegramsButNothingElse) {
  const auto events = write({.lost = 0.01, .repeated = 0.02, .damaged = 0.01});
  ASSERT_GT(faults_.lost + faults_.damaged, 5U);
  CaptureReader reader(file_, settings_.scanner.rig);
  const auto items = read_all(reader);
  EXPECT_LT(items.size(), events.size());
  // One frame carries part of one telegram, or one reading; an acknowledgement carries nothing.
  EXPECT_GE(items.size() + faults_.lost + faults_.damaged, events.size());
  std::size_t at = 0;
  for (const auto& item : items) {
    while (at < events.size() &&
           (events[at].index() != item.index() || receipt_ns(events[at]) != receipt_ns(item)))
      ++at;
    ASSERT_LT(at, events.size()) << "an item that was never sent, or not then";
    if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
      ASSERT_EQ((*scan)->echoes[0].ranges, to_scan(std::get<LaserTelegram>(events[at])).echoes[0].ranges);
    }
  }
}

/// Root mean square of the points' distances to the true surfaces.
double thickness(const Measurements& beams, const PlateTrajectory& plate, const Calibration& calibration,
                 const RayCaster& surfaces) {
  const auto placed = SensorModel(calibration).place(beams, plate);
  double sum = 0;
  for (Eigen::Index i = 0; i < placed.points.cols(); ++i) {
    sum += std::pow(surfaces.distance(placed.points.col(i)), 2);
  }
  return std::sqrt(sum / static_cast<double>(placed.points.cols()));
}

struct Aligned {
  Measurements beams;
  PlateTrajectory plate;
  AlignmentReport report;
};

Aligned align(const SimulatedRecording& recording, const Rig& rig) {
  Aligned aligned;
  ClockAligner aligner(
      rig, {},
      {.trajectory = [&](PlateTrajectory plate) { aligned.plate = std::move(plate); },
       .measurements =
           [&](const std::shared_ptr<const Measurements>& beams) { aligned.beams.append(*beams); }});
  auto reading = recording.readings.begin();
  for (const auto& scan : recording.scans) {
    for (; reading != recording.readings.end() && reading->receipt_ns < scan.receipt_ns; ++reading) {
      aligner.add(*reading);
    }
    aligner.add(std::make_shared<const Scan>(scan));
  }
  for (; reading != recording.readings.end(); ++reading) aligner.add(*reading);
  aligned.report = aligner.finish();
  return aligned;
}

TEST_F(RoundTrip, AlignedClocksAndTheTruthPutThePointsOnTheSurfaces) {
  settings_.scanner.duration = 5;
  settings_.scanner.field.step = 2 * kDegree;  // a quarter of the beams: enough here
  for (const int late : {0, -1}) {
    for (const std::string name : {"office", "hall", "street"}) {  // nothing moves or grows there
      auto& scanner = settings_.scanner;
      for (auto& laser : scanner.rig.lasers) laser.period_offset = late;
      scanner.truth = draw_truth(nominal_calibration(scanner.rig),
                                 {.tau = 0.02, .alpha = 3 * kDegree, .lambda = 5 * kDegree, .eta = 0.04}, 1);
      const Scene scene = built_in_scene(name);
      const RayCaster surfaces(scene);
      const auto aligned = align(simulate_recording(settings_, scene), scanner.rig);
      const double found = thickness(aligned.beams, aligned.plate, scanner.truth, surfaces);
      const auto ideal = simulate_measurements(scanner, scene);
      EXPECT_NEAR(static_cast<double>(aligned.beams.size()), static_cast<double>(ideal.beams.size()),
                  0.01 * static_cast<double>(ideal.beams.size()));
      // The noise is the same; stamps of whole microseconds and the delays' envelopes add micrometres.
      EXPECT_LT(found, 1.02 * thickness(ideal.beams, ideal.plate, scanner.truth, surfaces)) << name;
      Calibration off = scanner.truth;
      for (auto& laser : off.lasers) laser.eta.value += 1e-3;
      EXPECT_GT(thickness(aligned.beams, aligned.plate, off, surfaces), 1.1 * found) << name << ": η matters";
    }
  }
}

}  // namespace
}  // namespace crisp
