// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/device_stamps.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::clock;

/// A device that counts what it sends, every 20 ms.
class CountingDevice {
 public:
  /// @return how many it has sent since the one before, as its counter and its clock show
  std::int64_t send(std::uint16_t counter, double at) {
    const auto device_us = static_cast<std::uint32_t>(1e6 * at);
    const auto receipt_ns = static_cast<std::int64_t>(1e9 * at) + 1'700'000'000'000'000'000;
    return stamps_.accept(counter, device_us, receipt_ns, at).steps;
  }

 private:
  DeviceStamps stamps_{"laser1", WindowedClockFit("laser1", 5e-8), 0.02};
};

TEST(DeviceStamps, TheCounterKnowsBetterThanAnUnevenIntervalHowManyWereSent) {
  CountingDevice device;
  for (std::uint16_t k = 0; k < 50; ++k) device.send(k, 0.02 * k);
  EXPECT_EQ(device.send(50, 0.02 * 50 + 0.013), 1) << "a late one";
  EXPECT_EQ(device.send(51, 0.02 * 51), 1);
  EXPECT_EQ(device.send(71, 0.02 * 71 - 0.012), 20) << "19 lost ones, and an early one";
}

TEST(DeviceStamps, ACounterThatContradictsTheClockIsNotBelieved) {
  CountingDevice device;
  for (std::uint16_t k = 0; k < 50; ++k) device.send(k, 0.02 * k);
  EXPECT_EQ(device.send(550, 0.02 * 50), 1);
}

}  // namespace
}  // namespace crisp
