// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/emulate/emulator.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <cmath>
#include <future>
#include <utility>

#include <crisp/error.hpp>

#include "grabbers/wire/plate_sentence.hpp"
#include "grabbers/wire/scan_encoding.hpp"

namespace crisp::emulate {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

constexpr auto kNap = 2ms;                          // polling interval of the other threads' state
constexpr auto kLongestNap = 50ms;                  // so that an interruption is noticed
constexpr std::size_t kEnoughWaiting = 256 * 1024;  // [bytes] for a client, before the next scan is sent

asio::ip::address ip_of(const std::string& text) {
  boost::system::error_code failure;
  auto ip = asio::ip::make_address(text, failure);
  if (failure) throw Error("\"" + text + "\" is no IP address", "write it like 127.0.0.1");
  return ip;
}

/// Source address of the plate's datagrams to a loopback address: the rig's plate, if it has a loopback one,
/// too.
asio::ip::address plate_address(const Rig& rig, const asio::ip::address& to) {
  boost::system::error_code unknown;
  const auto own = asio::ip::make_address(rig.plate.address.ip, unknown);
  return own.is_loopback() && own.is_v4() == to.is_v4() ? own : to;
}

}  // namespace

void Emulator::check(const EmulatorSettings& settings) const {
  if (!(std::isfinite(settings.speed) && settings.speed >= 0)) {
    throw Error("devices cannot be emulated at that speed",
                "give the speed relative to real time, or 0 for no pause");
  }
  for (const RigLaser& laser : rig_.lasers) {
    if (settings.network || ip_of(laser.address.ip).is_loopback()) continue;
    throw Error(
        "the emulated " + laser.name + " would be open to the network at " + laser.address.ip,
        "give a rig with loopback addresses, such as configs/loopback.yaml, or allow it: network: true");
  }
}

Emulator::Emulator(Rig rig, EmulatorSettings settings)
    : rig_(std::move(rig)),
      settings_(std::move(settings)),
      work_(context_.get_executor()),
      plate_(context_),
      plate_dice_(settings_.faults, rig_.lasers.size()) {
  check(settings_);
  for (RigLaser& laser : rig_.lasers) {
    lasers_.push_back(std::make_unique<EmulatedLaser>(context_, laser.address,
                                                      FaultDice(settings_.faults, lasers_.size()),
                                                      EmulatedClock(skew_of(lasers_.size()))));
    laser.address.port = lasers_.back()->port();
  }
  plate_to_ = {ip_of(settings_.plate_to.ip), settings_.plate_to.port};
  plate_.open(plate_to_.protocol());
  // A socket that is bound nowhere would take datagrams from the network.
  if (plate_to_.address().is_loopback()) plate_.bind({plate_address(rig_, plate_to_.address()), 0});
  for (const auto& laser : lasers_) laser->start();
  thread_ = std::thread([this] { context_.run(); });
}

Emulator::~Emulator() {
  in_thread([this] {
    for (const auto& laser : lasers_) laser->stop();
  });
  work_.reset();
  thread_.join();
}

double Emulator::skew_of(std::size_t laser) const {
  const auto& skews = settings_.faults.skews;
  return laser < skews.size() ? skews[laser] : 0;
}

EmulatedLedger Emulator::ledger() {
  EmulatedLedger ledger = plate_ledger_;
  in_thread([&] {
    for (const auto& laser : lasers_) ledger += laser->ledger();
  });
  return ledger;
}

void Emulator::in_thread(const std::function<void()>& work) {
  std::promise<void> done;
  asio::post(context_, [&] {
    try {
      work();
      done.set_value();
    } catch (...) {
      done.set_exception(std::current_exception());
    }
  });
  done.get_future().get();
}

std::size_t Emulator::waiting_bytes() {
  std::size_t most = 0;
  in_thread([&] {
    for (const auto& laser : lasers_) most = std::max(most, laser->waiting_bytes());
  });
  return most;
}

std::vector<std::string> Emulator::without_client() {
  std::vector<std::string> names;
  in_thread([&] {
    for (std::size_t i = 0; i < lasers_.size(); ++i) {
      if (lasers_[i]->subscribers() == 0) names.push_back(rig_.lasers[i].name);
    }
  });
  return names;
}

void Emulator::await_clients(const Interrupted& interrupted) {
  while (!interrupted() && !without_client().empty()) std::this_thread::sleep_for(kNap);
}

void Emulator::await_time(std::int64_t item_ns, const Interrupted& interrupted) {
  if (settings_.speed == 0) {
    if (settings_.wait_for_clients) await_clients(interrupted);
    while (!interrupted() && waiting_bytes() > kEnoughWaiting) std::this_thread::sleep_for(kNap);
    return;
  }
  const std::chrono::duration<double, std::nano> since(static_cast<double>(item_ns - start_->item_ns) /
                                                       settings_.speed);
  const auto due = start_->here + std::chrono::duration_cast<std::chrono::nanoseconds>(since);
  while (!interrupted()) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= due) return;
    std::this_thread::sleep_until(std::min(due, now + kLongestNap));
  }
}

void Emulator::send(const HubItem& item, const Interrupted& interrupted) {
  if (start_) return deliver(item, interrupted);
  keep(item);
  if (!keeps_on()) begin(interrupted);
}

void Emulator::keep(const HubItem& item) {
  kept_.push_back(item);
  const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
  if (scan == nullptr || !introduced_.insert((*scan)->laser).second) return;
  const wire::ScanData data = wire::to_scan_data(**scan);
  in_thread([&] { lasers_.at((*scan)->laser)->introduce(data); });
}

/// Whether some laser has had no scan yet, and may have one soon.
bool Emulator::keeps_on() const {
  constexpr std::int64_t kLongest_ns = 1'000'000'000;
  return settings_.wait_for_clients && settings_.speed > 0 && introduced_.size() < lasers_.size() &&
         receipt_ns(kept_.back()) - receipt_ns(kept_.front()) < kLongest_ns;
}

void Emulator::begin(const Interrupted& interrupted) {
  if (settings_.wait_for_clients) await_clients(interrupted);
  start_ = {std::chrono::steady_clock::now(), receipt_ns(kept_.front())};
  for (const HubItem& item : std::exchange(kept_, {})) deliver(item, interrupted);
}

void Emulator::deliver(const HubItem& item, const Interrupted& interrupted) {
  await_time(receipt_ns(item), interrupted);
  if (interrupted()) return;
  if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
    const wire::ScanData data = wire::to_scan_data(**scan);
    in_thread([&] { lasers_.at((*scan)->laser)->send(data); });
  } else {
    send(std::get<PlateReading>(item));
  }
}

void Emulator::send(const PlateReading& reading) {
  if (plate_dice_.loses()) {
    ++plate_ledger_.readings_lost;
    return;
  }
  std::string sentence = wire::encode_plate_sentence(reading);
  const bool damaged = plate_dice_.damages();
  if (damaged) plate_dice_.flip_a_bit(sentence);
  ++(damaged ? plate_ledger_.readings_damaged : plate_ledger_.readings);
  boost::system::error_code nobody_listens;  // as little as a plate would notice
  plate_.send_to(asio::buffer(sentence), plate_to_, 0, nobody_listens);
}

void Emulator::finish(const Interrupted& interrupted) {
  if (!kept_.empty()) begin(interrupted);
  const auto deadline = std::chrono::steady_clock::now() + 2s;
  while (waiting_bytes() > 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(kNap);
}

}  // namespace crisp::emulate
