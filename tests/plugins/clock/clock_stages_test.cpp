// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/clock_stages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <crisp/runner.hpp>

#include "plugins/clock/register.hpp"
#include "tests/plugins/clock/simulated_scanner.hpp"

namespace crisp {
namespace {

using namespace crisp::clock;
using ::testing::HasSubstr;

constexpr double kSeconds = 5;

/// Gives what three simulated lasers and a plate sent, in the order of receipt.
class SimulatedHub final : public Stage {
 public:
  static void describe(StageDescription<SimulatedHub>& d) {
    d.name("test.hub").summary("gives simulated scans and readings").gives<Scan>().gives<PlateReading>();
    d.option("lasers", &SimulatedHub::lasers_, "how many").range(0, 3);
  }
  void process(const Inputs&, Outputs& out, Context&) override {
    std::multimap<std::int64_t, std::function<void()>> arrivals;
    for (std::uint16_t i = 0; i < static_cast<std::uint16_t>(lasers_); ++i) {
      test::SimulatedLaser laser;
      laser.clock.skew = [=](double) { return (i + 1) * 50e-6; };
      for (const auto& turn : laser.turns(1, i, kSeconds)) {
        arrivals.emplace(turn.scan.receipt_ns, [&out, scan = turn.scan] { out.give(Scan(scan)); });
      }
    }
    for (const auto& reading : test::SimulatedPlate{}.readings(1, kSeconds)) {
      arrivals.emplace(reading.receipt_ns, [&out, reading] { out.give(PlateReading(reading)); });
    }
    for (const auto& [receipt, give] : arrivals) give();
  }

 private:
  int lasers_ = 3;
};

struct Seen {
  std::size_t maps = 0;
  double least_std_error = 1;  // [s] of the maps
  std::size_t trajectories = 0;
  std::size_t measurements = 0;
  bool trajectory_first = true;
};
Seen seen;

class Watcher final : public Stage {
 public:
  static void describe(StageDescription<Watcher>& d) {
    d.name("test.watcher").summary("counts what clock stages give");
    d.takes<PlateTrajectory>().takes<Measurements>().takes<ClockMap>();
  }
  void process(const Inputs& in, Outputs&, Context&) override {
    if (const auto* map = in.find<ClockMap>()) {
      ++seen.maps;
      seen.least_std_error = std::min(seen.least_std_error, map->std_error);
    }
    if (in.find<PlateTrajectory>()) ++seen.trajectories;
    if (const auto* measurements = in.find<Measurements>()) {
      seen.measurements += measurements->size();
      seen.trajectory_first = seen.trajectory_first && seen.trajectories > 0;
    }
  }
};

class ClockStages : public ::testing::TestWithParam<const char*> {
 protected:
  ClockStages() {
    registrar_.stage<SimulatedHub>();
    registrar_.stage<Watcher>();
    register_clock(registrar_);
    run_.registrar = &registrar_;
    seen = {};
  }

  StageReport run(const std::string& stage, int lasers) {
    const StageSpec hub{.stage = "test.hub", .with = {{"lasers", OptionScalar(std::int64_t{lasers})}}};
    Pipeline pipeline = build_pipeline({hub, {.stage = stage}, {.stage = "test.watcher"}}, run_);
    return run_pipeline(pipeline, run_).at(1).report;
  }

  Registrar registrar_;
  RunSettings run_;
};

TEST_P(ClockStages, GivesTheTrajectoryThenAllMeasurementsAndTheMaps) {
  const auto report = run(GetParam(), 3);
  EXPECT_EQ(seen.trajectories, 1u);
  EXPECT_EQ(seen.maps, 4u);
  EXPECT_TRUE(seen.trajectory_first);
  const auto& devices = report.section.at("devices");
  ASSERT_EQ(devices.size(), 4u);
  EXPECT_EQ(seen.measurements, 541 * (devices.at(0).at("stamps").get<std::size_t>() +
                                      devices.at(1).at("stamps").get<std::size_t>() +
                                      devices.at(2).at("stamps").get<std::size_t>()));
  EXPECT_EQ(devices.at(1).at("device"), "laser2");
  EXPECT_NEAR(devices.at(1).at("skew_ppm").get<double>(), 100,
              4 * devices.at(1).at("skew_std_error_ppm").get<double>());
  EXPECT_NEAR(devices.at(1).at("delay_median").get<double>(), 1e-4 * std::log(2), 2e-5);
  EXPECT_EQ(report.counts.at("laser3: telegrams lost"), 0u);
  EXPECT_THAT(report.lines.at(0), HasSubstr("skew/ppm"));
}

INSTANTIATE_TEST_SUITE_P(All, ClockStages, ::testing::Values("clock.convex_hull", "clock.receipt"),
                         [](const auto& name) { return std::string(name.param).substr(6); });

TEST_F(ClockStages, CountTheDelaysThatReceiptsKeepInTheStandardErrors) {
  constexpr double kMedianDelay = 1e-4 * 0.693;
  run("clock.convex_hull", 3);
  EXPECT_LT(seen.least_std_error, kMedianDelay / 4);
  seen = {};
  run("clock.receipt", 3);
  EXPECT_GT(seen.least_std_error, kMedianDelay * 0.4) << "the plate's delays are shorter";
}

TEST_F(ClockStages, WarnsOfAMissingLaserAndRefusesToGoOnWithoutAny) {
  EXPECT_THAT(run("clock.convex_hull", 2).warnings, ::testing::Contains("laser3: no data of it"));
  EXPECT_THROW(run("clock.convex_hull", 0), Error);
}

}  // namespace
}  // namespace crisp
