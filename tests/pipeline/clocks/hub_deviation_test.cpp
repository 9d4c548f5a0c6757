// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/hub_deviation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/simulated_stamps.hpp"

namespace crisp {
namespace {

using namespace crisp::clocks;
using test::Delays;
using test::exponential_delays;
using test::Random;

using Deviation = std::function<double(double)>;  // [s] of the hub's clock, at a true time

struct Device {
  double rate = 50;  // [Hz]
  double skew = 0;
  Delays delays = exponential_delays(1e-4);
  Deviation own = [](double) { return 0.0; };  // of its delay
};

std::vector<ReceivedStamp> received(const Device& device, double duration, const Deviation& hub,
                                    std::uint64_t seed) {
  Random random(seed);
  std::vector<ReceivedStamp> stamps;
  for (double t = 0; t < duration; t += 1 / device.rate) {
    const double arrival = t + device.delays(random) + device.own(t);
    const double shown = arrival + hub(arrival);
    stamps.push_back({.hub = shown, .lead = shown - t * (1 - device.skew)});
  }
  return stamps;
}

std::vector<std::vector<ReceivedStamp>> received_of_all(const std::vector<Device>& devices,
                                                        const Deviation& hub, std::uint64_t seed = 1,
                                                        double duration = 20) {
  std::vector<std::vector<ReceivedStamp>> all;
  for (const Device& device : devices)
    all.push_back(received(device, duration, hub, 100 * seed + all.size()));
  return all;
}

std::vector<Device> three_lasers_and_a_plate() {
  return {{.skew = 60e-6}, {.skew = -90e-6}, {.skew = 20e-6}, {.rate = 500, .skew = -40e-6}};
}

/// [s] How far what is left of a deviation is from a straight line, at most.
double bend_left(const HubDeviation& found, const Deviation& hub, double duration = 20) {
  std::vector<double> t, left;
  for (double at = 0.5; at < duration - 0.5; at += 0.1) {
    const double shown = at + hub(at);
    if (found.is_unsure(shown)) continue;
    t.push_back(at);
    left.push_back(hub(at) - found.at(shown));
  }
  double mean_t = 0, mean = 0, tt = 0, tl = 0;
  for (std::size_t i = 0; i < t.size(); ++i) mean_t += t[i], mean += left[i];
  mean_t /= static_cast<double>(t.size());
  mean /= static_cast<double>(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    tt += (t[i] - mean_t) * (t[i] - mean_t);
    tl += (t[i] - mean_t) * (left[i] - mean);
  }
  double most = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    most = std::max(most, std::abs(left[i] - mean - tl / tt * (t[i] - mean_t)));
  }
  return most;
}

TEST(HubDeviation, FindsStepsOfTheHubsClock) {
  for (const double by : {0.5, -0.05, 5e-3, -5e-3, 5e-4}) {
    const Deviation hub = [=](double t) { return t < 8 ? 0 : by; };
    const auto found = find_hub_deviation(received_of_all(three_lasers_and_a_plate(), hub));
    ASSERT_TRUE(found) << by;
    ASSERT_EQ(found->steps().size(), 1U) << by;
    EXPECT_NEAR(found->steps()[0].by, by, 50e-6);
    EXPECT_NEAR(found->steps()[0].at, 8 + std::min(0.0, by), 0.4 + std::abs(by)) << by;
    EXPECT_LT(bend_left(*found, hub), 30e-6) << by;
  }
}

TEST(HubDeviation, OfALongStepForwardKeepsTheDevicesSkews) {
  const Deviation hub = [](double t) { return t < 2.7 ? 0 : 4.3; };
  const auto found = find_hub_deviation(received_of_all(three_lasers_and_a_plate(), hub, 1, 6));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->steps().size(), 1U);
  EXPECT_NEAR(found->steps()[0].begin(), 2.7, 0.3);
  EXPECT_FALSE(found->is_unsure(2.0)) << "what came before the gap came before the step";
  EXPECT_FALSE(found->is_unsure(2.7 + 4.3 + 0.7));
  // A skew of 100 ppm over the 4.3 s that were left out is 0.43 ms.
  EXPECT_NEAR(found->at(8.5) - found->at(1.5), 4.3, 60e-6);
}

TEST(HubDeviation, FollowsAClockThatIsSlewed) {
  for (const double ppm : {500.0, -500.0, 5000.0}) {
    const Deviation hub = [=](double t) { return 1e-6 * ppm * (std::clamp(t, 6.0, 11.0) - 6); };
    const auto found = find_hub_deviation(received_of_all(three_lasers_and_a_plate(), hub));
    ASSERT_TRUE(found) << ppm;
    // A straight piece of 0.16 s misses a kink by an eighth of it times the change of the rate.
    EXPECT_LT(bend_left(*found, hub), 30e-6 + 0.16 / 4 * 1e-6 * std::abs(ppm)) << ppm;
  }
}

TEST(HubDeviation, FollowsAClockThatWanders) {
  const Deviation hub = [](double t) { return 2e-3 * std::sin(1.3 * t); };
  const auto found = find_hub_deviation(received_of_all(three_lasers_and_a_plate(), hub));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->steps().empty());
  EXPECT_LT(bend_left(*found, hub), 40e-6);
}

TEST(HubDeviation, IsFoundFromOneLaserAndThePlate) {
  const Deviation hub = [](double t) { return t < 8 ? 0 : 2e-3; };
  auto devices = three_lasers_and_a_plate();
  devices.erase(devices.begin(), devices.begin() + 2);
  const auto found = find_hub_deviation(received_of_all(devices, hub));
  ASSERT_TRUE(found);
  EXPECT_LT(bend_left(*found, hub), 30e-6);
}

TEST(HubDeviation, IsNoneWhereADeviceContradicts) {
  const Deviation none = [](double) { return 0.0; };
  const Deviation step = [](double t) { return t < 8 ? 0 : 2e-3; };
  auto devices = three_lasers_and_a_plate();
  devices[0].own = step;
  EXPECT_FALSE(find_hub_deviation(received_of_all(devices, none))) << "one laser's delay alone";
  devices[1].own = devices[2].own = step;
  EXPECT_FALSE(find_hub_deviation(received_of_all(devices, none)))
      << "the lasers' switch, but not the plate's";
}

TEST(HubDeviation, IsNoneOfOneDevice) {
  const Deviation step = [](double t) { return t < 8 ? 0 : 2e-3; };
  EXPECT_FALSE(find_hub_deviation(received_of_all({Device{}}, step)));
  EXPECT_FALSE(find_hub_deviation({}));
  EXPECT_FALSE(find_hub_deviation(std::vector<std::vector<ReceivedStamp>>(3)));
}

TEST(HubDeviation, IsNoneInUsualRecordings) {
  const Deviation none = [](double) { return 0.0; };
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    auto devices = three_lasers_and_a_plate();
    if (seed % 3 == 1) {
      for (auto& device : devices) device.delays = test::gamma_delays(2, 1e-3);
    }
    if (seed % 3 == 2) {
      for (auto& device : devices) device.delays = test::bursty_delays(3e-4, 20e-3, 40, 0.003);
    }
    if (seed % 2 == 0) devices.erase(devices.begin(), devices.begin() + 2);
    found += find_hub_deviation(received_of_all(devices, none, seed)) ? 1 : 0;
  }
  EXPECT_EQ(found, 0);
}

}  // namespace
}  // namespace crisp
