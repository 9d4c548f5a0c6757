// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/packet_order.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "grabbers/capture/ordered_capture.hpp"
#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kSecond = 1'000'000'000;

/// Two lasers and a plate for 6 s.
std::vector<Frame> frames() { return Scenario{.scans = 300}.frames(); }
std::vector<std::string> items() { return describe(Scenario{.scans = 300}.items()); }

/// Frames in parts of equal length, in another order.
std::vector<Frame> in_parts(const std::vector<Frame>& all, const std::vector<std::size_t>& order) {
  std::vector<Frame> mixed;
  for (const std::size_t part : order) {
    const auto at = [&](std::size_t i) {
      return all.begin() + static_cast<std::ptrdiff_t>(i * all.size() / order.size());
    };
    mixed.insert(mixed.end(), at(part), at(part + 1));
  }
  return mixed;
}

/// Frames of a hub whose clock is set by this much, in the middle of the capture.
std::vector<Frame> with_step(std::int64_t by_ns) {
  auto all = frames();
  for (std::size_t i = all.size() / 2; i < all.size(); ++i) all[i].time_ns += by_ns;
  return all;
}

/// Without when it was received.
std::vector<std::string> contents(std::vector<std::string> lines) {
  for (auto& line : lines) line.erase(0, line.find(' '));
  return lines;
}

/// [s] By how much receipts are off those of the scenario: the least and the most.
std::pair<double, double> receipt_errors(const std::vector<std::string>& found) {
  const auto expected = items();
  std::pair<double, double> errors{1e9, -1e9};
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    const double error = 1e-9 * (std::stod(found[i]) - std::stod(expected[i]));
    errors = {std::min(errors.first, error), std::max(errors.second, error)};
  }
  return errors;
}

TEST(PacketOrder, ReadsAFileInOrderAsItIs) {
  const MemoryFile file(pcap_file(frames()));
  const PacketOrder order = determine_packet_order(file.path());
  EXPECT_EQ(order.stretches.size(), 1U);
  EXPECT_THAT(order.remarks, IsEmpty());
}

TEST(PacketOrder, ReadsSwappedHalvesInTheOrderOfTheirTimes) {
  const auto reading = read_capture(pcap_file(in_parts(frames(), {1, 0})));
  EXPECT_EQ(reading.items, items());
  EXPECT_THAT(reading.statistics.remarks, ElementsAre(HasSubstr("(2 parts, each in order)")));
  EXPECT_TRUE(reading.statistics.losses.all().empty());
  for (const auto& device : reading.statistics.devices)
    EXPECT_TRUE(device.losses.all().empty()) << device.name;
}

TEST(PacketOrder, ReadsTenPartsInReverseOrder) {
  const auto reading = read_capture(pcap_file(in_parts(frames(), {9, 8, 7, 6, 5, 4, 3, 2, 1, 0})));
  EXPECT_EQ(reading.items, items());
  EXPECT_THAT(reading.statistics.remarks, ElementsAre(HasSubstr("(10 parts, each in order)")));
}

TEST(PacketOrder, ReadsPartsOfAPcapngFileWithItsSections) {
  const auto all = frames();
  const auto section = [&](PcapngBuilder& builder, std::size_t begin, std::size_t end,
                           std::uint8_t resolution) {
    builder.section().interface(1, 9).interface(1, resolution);
    for (std::size_t i = begin; i < end; ++i) {
      Frame frame = all[i];
      frame.interface = 1;
      builder.packet(frame, static_cast<std::uint64_t>(frame.time_ns) / (resolution == 9 ? 1 : 1000));
    }
  };
  PcapngBuilder builder(ByteOrder::Little);
  section(builder, all.size() / 2, all.size(), 6);
  section(builder, 0, all.size() / 2, 9);
  const auto reading = read_capture(builder.bytes());
  EXPECT_EQ(contents(reading.items), contents(items()));
}

TEST(PacketOrder, MergesTwoInterfacesWhoseCapturesLieOneBehindTheOther) {
  auto all = frames();
  std::stable_partition(all.begin(), all.end(),
                        [](const Frame& frame) { return frame.bytes[23] == 6; });  // TCP first
  const auto reading = read_capture(pcap_file(all));
  EXPECT_EQ(reading.items, items());
}

TEST(PacketOrder, LetsTimeGoOnWhereTheHubsClockIsSetBack) {
  for (const std::int64_t by : {kSecond / 2, 10 * kSecond, 3600 * kSecond, 400 * 86'400 * kSecond}) {
    const auto reading = read_capture(pcap_file(with_step(-by)));
    EXPECT_EQ(contents(reading.items), contents(items())) << by;
    const auto [least, most] = receipt_errors(reading.items);
    EXPECT_NEAR(least, 0, 3e-3) << by;
    EXPECT_NEAR(most, 0, 3e-3) << by;
    EXPECT_THAT(reading.statistics.remarks, ElementsAre(HasSubstr("clock was set back 1 time(s)"))) << by;
    for (const auto& device : reading.statistics.devices) EXPECT_TRUE(device.losses.all().empty()) << by;
  }
}

TEST(PacketOrder, LetsTimeGoOnWhereThe32BitsOfSecondsWrap) {
  auto all = frames();
  const std::int64_t wrap = (std::int64_t{1} << 32) * kSecond;
  for (auto& frame : all) {
    frame.time_ns += wrap - kStart - 3 * kSecond;
    if (frame.time_ns >= wrap) frame.time_ns -= wrap;
  }
  const auto reading = read_capture(pcap_file(all));
  EXPECT_EQ(contents(reading.items), contents(items()));
  for (const auto& device : reading.statistics.devices)
    EXPECT_TRUE(device.losses.all().empty()) << device.name;
}

TEST(PacketOrder, TakesOutTheOffsetOfAnInterfaceWithAnotherClock) {
  for (const std::int64_t ahead : {37 * kSecond, -37 * kSecond, 7200 * kSecond}) {
    auto all = frames();
    for (auto& frame : all) {
      if (frame.bytes[23] == 17) frame.time_ns += ahead;
    }
    const auto reading = read_capture(pcap_file(all));
    EXPECT_EQ(reading.items.size(), items().size());
    auto found = contents(reading.items), expected = contents(items());
    std::ranges::sort(found);
    std::ranges::sort(expected);
    EXPECT_EQ(found, expected);
    ASSERT_EQ(reading.statistics.remarks.size(), 1U) << ahead;
    EXPECT_THAT(reading.statistics.remarks[0],
                HasSubstr("packets between 192.168.0.10 and 192.168.0.100 are stamped"));
    for (const auto& device : reading.statistics.devices) {
      if (device.items == 0) continue;
      EXPECT_NEAR(1e-9 * static_cast<double>(device.first_ns - kStart), 0, 0.05) << device.name << ahead;
    }
  }
}

TEST(PacketOrder, TakesOutTheOffsetOfAnInterfaceThatALaserIsAt) {
  constexpr std::size_t kSource = 29, kDestination = 33;  // the last byte of an IPv4 address
  auto all = frames();
  for (auto& frame : all) {
    if (frame.bytes[kSource] == 2 || frame.bytes[kDestination] == 2) frame.time_ns += 37 * kSecond;
  }
  const auto reading = read_capture(pcap_file(all));
  ASSERT_EQ(reading.statistics.remarks.size(), 1U);
  EXPECT_THAT(reading.statistics.remarks[0],
              HasSubstr("between 192.168.0.2 and 192.168.0.100 are stamped +37.0"));
  EXPECT_EQ(reading.items.size(), items().size());
  for (const auto& device : reading.statistics.devices) {
    if (device.items == 0) continue;
    EXPECT_NEAR(1e-9 * static_cast<double>(device.first_ns - kStart), 0, 0.05) << device.name;
  }
}

TEST(PacketOrder, ReportsItWhereTimesGoBackTooOftenToSortThem) {
  auto all = frames();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i / 2 % 2 == 1) all[i].time_ns -= 3 * kSecond;  // of all senders
  }
  EXPECT_THAT(read_capture(pcap_file(all)).statistics.remarks,
              ElementsAre(HasSubstr("too often to sort them")));
}

}  // namespace
}  // namespace crisp
