// SPDX-License-Identifier: BSD-3-Clause
// All faults of the emulator at random, on a virtual clock: each loss is counted, clocks are found anew, and
// what comes is as true as without faults. tests/bench/live_trial.cpp does the same for as long as one likes,
// in real time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include <crisp/clock_aligner.hpp>

#include "grabbers/emulate/emulator.hpp"
#include "tests/grabbers/live/live_support.hpp"
#include "tests/support/simulated_items.hpp"

namespace crisp {
namespace {

using namespace crisp::emulate;
using namespace crisp::live;
using namespace crisp::simulate;

constexpr double kSeconds = 12;

/// By laser and ranges' hash: the hub times of a scan's first and last measurement.
using ScanTimes = std::map<std::pair<std::uint16_t, std::size_t>, std::pair<double, double>>;

std::size_t hash_of(const Measurements& scan) {
  std::size_t hash = scan.range.size();
  for (const float range : scan.range) hash = hash * 1'000'003 + std::hash<float>()(range);
  return hash;
}

struct Aligned {
  ScanTimes times;
  AlignmentReport report;
};

Aligned align(const std::vector<HubItem>& items, const Rig& rig) {
  Aligned aligned;
  OnlineAligner aligner(
      rig, {.mirror_half_width = kOnlineMirror}, {},
      {.trajectory = [](const PlateTrajectory&) {},
       .measurements =
           [&](const std::shared_ptr<const Measurements>& given) {
             const Measurements& scan = *given;
             if (scan.size() == 0) return;
             aligned.times[{scan.laser.front(), hash_of(scan)}] = {
                 1e-9 * static_cast<double>(scan.epoch_ns % 1'000'000'000'000) + scan.time.front(),
                 1e-9 * static_cast<double>(scan.epoch_ns % 1'000'000'000'000) + scan.time.back()};
           }});
  for (const HubItem& item : items) {
    if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
      aligner.add(*scan);
    } else {
      aligner.add(std::get<PlateReading>(item));
    }
  }
  aligned.report = aligner.finish();
  return aligned;
}

/// What became of one laser's scans, in the order in which they were sent.
struct Fate {
  bool delivered = false;
  bool restarted = false;  ///< the laser started again before it
};

/// Sends the items one by one, each at its recorded hub time, and checks the resulting items.
class Soak {
 public:
  explicit Soak(const EmulatedFaults& faults)
      : emulator_(rig(), {.speed = 0, .plate_to = {"127.0.0.1", plate_port_}, .faults = faults}),
        source_(emulator_.rig(), {.sick = {.reply_timeout = 600, .silence = 600, .max_reconnect_delay = 0.1},
                                  .plate_at = {.port = plate_port_},
                                  .clock = clock_.reader()}) {}

  void send(const HubItem& item) {
    clock_.ns = receipt_ns(item);
    emulator_.send(item, [] { return false; });
    const EmulatedLedger now = emulator_.ledger();
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
    const bool whole = now.delivered + now.readings > reported_.delivered + reported_.readings;
    if (scan != nullptr) {
      fates[(*scan)->laser].push_back({.delivered = whole, .restarted = now.restarted > reported_.restarted});
      if (!whole) uncertain_.at((*scan)->laser) = true;
    }
    reported_ = now;
    if (whole) await(item);
  }

  CaptureStatistics close() {
    while (auto item = source_.next_within(std::chrono::milliseconds(500))) came.push_back(std::move(*item));
    return source_.close();
  }

  EmulatedLedger ledger() { return emulator_.ledger(); }

  std::vector<HubItem> came;
  std::map<std::uint16_t, std::vector<Fate>> fates;

 private:
  Rig rig() const {
    Rig rig = test::loopback_rig();
    rig.plate.address.port = plate_port_;
    return rig;
  }

  static bool is_same(const HubItem& sent, const HubItem& came) {
    if (sent.index() != came.index()) return false;
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&came);
    if (scan == nullptr)
      return std::get<PlateReading>(sent).sequence == std::get<PlateReading>(came).sequence;
    const auto& other = std::get<std::shared_ptr<const Scan>>(sent);
    return other->laser == (*scan)->laser && other->echoes[0].ranges == (*scan)->echoes[0].ranges;
  }

  /// What was sent whole comes; but behind a damaged telegram that claims to be long, it may come later.
  void await(const HubItem& item) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
    const bool uncertain = scan != nullptr && uncertain_.at((*scan)->laser);
    const auto plate_timeout = uncertain ? std::chrono::milliseconds(20) : std::chrono::milliseconds(60'000);
    while (auto found = source_.next_within(plate_timeout)) {
      const bool same = is_same(item, *found);
      came.push_back(std::move(*found));
      if (!same) continue;
      if (scan != nullptr) uncertain_.at((*scan)->laser) = false;
      return;
    }
    EXPECT_TRUE(uncertain) << "what was sent whole did not come";
  }

  test::VirtualClock clock_;
  std::uint16_t plate_port_ = test::free_datagram_port();
  Emulator emulator_;
  LiveSource source_;
  EmulatedLedger reported_;
  std::vector<bool> uncertain_ = std::vector<bool>(3);
};

/// How many scans a client can know to be lost: those between two that came without a restart between them.
std::uint64_t countable_losses(const std::vector<Fate>& fates) {
  std::uint64_t losses = 0;
  std::uint64_t since = 0;
  bool any = false;
  for (const Fate& fate : fates) {
    if (fate.restarted) any = false;
    if (fate.delivered) {
      losses += any ? since : 0;
      any = true;
      since = 0;
    } else {
      ++since;
    }
  }
  return losses;
}

TEST(Soak, CountsEachLossFindsClocksAnewAndKeepsTheCloudTrue) {
  const auto items = test::simulated_items(kSeconds);
  Soak soak({.dropped = 0.01,
             .stalled = 0.01,
             .stall = 0.005,
             .split = 0.3,
             .damaged = 0.02,
             .restarted = 0.004,
             .lost = 0.01,
             .skews = {100e-6, -200e-6, 0},
             .seed = 11});
  for (const HubItem& item : items) soak.send(item);
  const CaptureStatistics statistics = soak.close();
  const EmulatedLedger ledger = soak.ledger();
  EXPECT_GT(ledger.faults(), 150U);
  EXPECT_GE(ledger.restarted, 3U);
  std::uint64_t restarts = 0;
  std::size_t scans = 0;
  for (std::uint16_t laser = 0; laser < 3; ++laser) {
    const auto& device = statistics.devices.at(laser);
    const auto& fates = soak.fates.at(laser);
    EXPECT_EQ(device.items, static_cast<std::uint64_t>(std::ranges::count(fates, true, &Fate::delivered)));
    EXPECT_EQ(device.losses.of(kTelegramsNeverCame), countable_losses(fates)) << "each loss is counted";
    restarts += device.notes.of("restarts of the device's clock");
    scans += device.items;
  }
  EXPECT_EQ(restarts, ledger.restarted);
  const auto& plate = test::of(statistics, "plate");
  EXPECT_EQ(plate.items, ledger.readings);
  EXPECT_NEAR(static_cast<double>(plate.losses.of(kReadingsNeverCame)),
              static_cast<double>(ledger.readings_lost + ledger.readings_damaged), 2)
      << "but for those at the very begin and end";

  const Rig rig = default_rig();
  const Aligned undisturbed = align(items, rig);
  const Aligned disturbed = align(soak.came, rig);
  EXPECT_GT(disturbed.times.size(), scans * 9 / 10);
  std::vector<double> errors;
  for (const auto& [scan, times] : disturbed.times) {
    const auto& [first, last] = undisturbed.times.at(scan);
    errors.push_back(std::max(std::abs(times.first - first), std::abs(times.second - last)));
  }
  std::ranges::sort(errors);
  RecordProperty("median", std::to_string(errors[errors.size() / 2]));
  RecordProperty("most", std::to_string(errors.back()));
  // A clock that is half a second old is known to some of the link's delays, of 0.1 ms on the mean.
  EXPECT_LT(errors[errors.size() / 2], 10e-6);
  EXPECT_LT(errors[errors.size() * 99 / 100], 400e-6);
  EXPECT_LT(errors.back(), 1e-3);
}

}  // namespace
}  // namespace crisp
