// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "tests/plugins/clock/aligned.hpp"

namespace crisp {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)
using ::testing::HasSubstr;

/// [s] By how much plate and beams are off one another in time, about the usual: from the plate's angle, of
/// one turn a second, at the beams' times.
double relative_error(const Aligned& aligned, const Turns& turns) {
  const auto scans = aligned.of_laser(0);
  EXPECT_EQ(scans.size(), turns.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < std::min(scans.size(), turns.size()); ++i) {
    const auto plate = aligned.stretches.front().plate.at(scans[i]->time.front());
    if (plate) errors.push_back(plate->angle / (2 * std::numbers::pi) - turns[i].begin);
  }
  EXPECT_GT(errors.size() + 5, turns.size());
  std::ranges::sort(errors);
  return errors.empty() ? HUGE_VAL
                        : std::max(errors.back() - errors[errors.size() / 2],
                                   errors[errors.size() / 2] - errors.front());
}

TEST(HubClock, IsNamedOnceWhereAllDevicesDeviateAlike) {
  const auto step = [](double by) { return [=](double t) { return t < 5 ? 0 : by; }; };
  const auto slew = [](double t) { return 500e-6 * (std::clamp(t, 2.0, 7.0) - 2); };
  for (const std::function<double(double)>& hub :
       {std::function<double(double)>(step(4000)), std::function<double(double)>(step(10)),
        std::function<double(double)>(step(0.5)), std::function<double(double)>(step(5e-3)),
        std::function<double(double)>(step(-5e-3)), std::function<double(double)>(slew)}) {
    const auto shifted = [&](std::int64_t& receipt_ns) {
      receipt_ns += std::llround(1e9 * hub(1e-9 * static_cast<double>(receipt_ns - kStart_ns)));
    };
    std::vector<Turns> lasers;
    for (std::uint16_t i = 0; i < 3; ++i) lasers.push_back(three_lasers(4)[i].turns(4, i, 12));
    auto readings = SimulatedPlate{}.readings(4, 12);
    for (auto& turns : lasers) {
      for (auto& turn : turns) shifted(turn.scan.receipt_ns);
    }
    for (auto& reading : readings) shifted(reading.receipt_ns);
    const auto aligned = align(lasers, readings);
    EXPECT_THAT(aligned.report.caveats, ::testing::IsEmpty()) << hub(10);
    EXPECT_THAT(aligned.report.warnings,
                ::testing::ElementsAre(HasSubstr("the hub's clock deviates by up to")))
        << hub(10);
    for (const auto& device : aligned.report.devices) EXPECT_THAT(device.delay_steps, ::testing::IsEmpty());
    EXPECT_LT(relative_error(aligned, lasers[0]), 60e-6) << hub(10);
  }
}

TEST(HubClock, SetForwardByMoreThanAPauseIsOneStepOfOneRecording) {
  std::vector<Turns> lasers = {three_lasers(4)[0].turns(4, 0, 12)};
  auto readings = SimulatedPlate{}.readings(4, 12);
  const auto set_forward = [](std::int64_t& receipt_ns) {
    if (receipt_ns > kStart_ns + 5'000'000'000) receipt_ns += 60'000'000'000;
  };
  for (auto& turn : lasers[0]) set_forward(turn.scan.receipt_ns);
  for (auto& reading : readings) set_forward(reading.receipt_ns);
  const auto aligned = align(lasers, readings);
  ASSERT_EQ(aligned.report.devices.size(), 2U) << "a laser and the plate, in one recording";
  ASSERT_EQ(aligned.report.hub_steps.size(), 1U);
  EXPECT_NEAR(aligned.report.hub_steps[0].by, 60, 1e-3);
  EXPECT_NEAR(aligned.report.hub_steps[0].at, kStart + 5, 0.1);
  for (const auto& device : aligned.report.devices) EXPECT_TRUE(device.silences.empty()) << device.device;
  const auto scans = aligned.of_laser(0);
  EXPECT_NEAR(scans.back()->time.front() - scans.front()->time.front(),
              lasers[0].back().begin - lasers[0].front().begin, 2e-3);
}

}  // namespace
}  // namespace crisp
