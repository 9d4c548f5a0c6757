// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/hub_forward_step.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

namespace crisp {
namespace {

using namespace crisp::clocks;
using ::testing::Eq;
using ::testing::Optional;

constexpr double kGap = 3;  // [s] true time of the gap

/// Three devices that send every 20 ms for 4 s; a hub whose clock, and devices whose clocks show what they
/// are given.
struct Traffic {
  std::function<double(double)> hub = [](double t) {
    return t;
  };  ///< [s] receipt of what is sent at a true time
  std::function<double(std::size_t, double)> device = [](std::size_t, double t) { return t; };  ///< [s]
  std::size_t devices = 3;

  std::optional<std::int64_t> step_ns() const {
    ForwardStep found;
    for (int k = 0; k < 200; ++k) {
      const double t = 0.02 * k;
      for (std::size_t i = 0; i < devices; ++i) {
        const auto shown = std::llround(1e6 * (4294 + device(i, t)));  // wraps at 0.97 s
        const DeviceStamp stamp{.receipt_ns = std::llround(1e9 * hub(t)),
                                .device_us = static_cast<std::uint32_t>(shown)};
        t < kGap ? found.before(i, stamp) : found.after(i, stamp);
      }
    }
    return found.size_ns();
  }
};

double after_gap(double t, double by) { return t < kGap ? t : t + by; }

TEST(ForwardStep, IsFoundWhereAllDevicesRanOn) {
  for (const double by : {5.0, 60.0, 86'400.0})
    EXPECT_THAT((Traffic{.hub = [=](double t) { return after_gap(t, by); }}).step_ns(),
                Optional(Eq(std::llround(1e9 * by))));
}

TEST(ForwardStep, IsNoneWhereTheDevicesRanThroughAPause) {
  for (const double by : {5.0, 60.0, 86'400.0, 4294.967296, 2 * 4294.967296}) {
    const auto pause = [=](double t) { return after_gap(t, by); };
    EXPECT_EQ((Traffic{.hub = pause, .device = [=](std::size_t, double t) { return pause(t); }}).step_ns(),
              std::nullopt)
        << by;
  }
}

TEST(ForwardStep, IsNoneWhereOneDeviceRanThroughAPause) {
  const auto pause = [](double t) { return after_gap(t, 10); };
  EXPECT_EQ((Traffic{.hub = pause, .device = [=](std::size_t i, double t) { return i == 1 ? pause(t) : t; }})
                .step_ns(),
            std::nullopt);
}

TEST(ForwardStep, IsNoneWhereTheDevicesBeganAnew) {
  const auto pause = [](double t) { return after_gap(t, 10); };
  EXPECT_EQ((Traffic{.hub = pause,
                     .device = [=](std::size_t i,
                                   double t) { return t < kGap ? 1000 + static_cast<double>(i) + t : t; }})
                .step_ns(),
            std::nullopt);
}

TEST(ForwardStep, IsNoneAfterABacklog) {
  // The hub halted for 10 s and then received 10 s of telegrams within a second.
  const auto late = [](double t) { return after_gap(t, 10); };
  EXPECT_EQ((Traffic{.hub = late,
                     .device = [](std::size_t, double t) { return t < kGap ? t : kGap + 11 * (t - kGap); }})
                .step_ns(),
            std::nullopt);
}

TEST(ForwardStep, NeedsTwoDevices) {
  EXPECT_EQ((Traffic{.hub = [](double t) { return after_gap(t, 10); }, .devices = 1}).step_ns(),
            std::nullopt);
}

TEST(ForwardStep, OfAClockThatStandsStillIsNone) {
  EXPECT_EQ((Traffic{.hub = [](double t) { return after_gap(t, 10); },
                     .device = [](std::size_t, double) { return 1.0; }})
                .step_ns(),
            std::nullopt);
}

}  // namespace
}  // namespace crisp
