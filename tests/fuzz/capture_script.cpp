// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/capture_script.hpp"

#include <algorithm>

#include <crisp/error.hpp>
#include <crisp/hub_item.hpp>

#include "grabbers/capture/hub_traffic_encoder.hpp"
#include "grabbers/wire/plate_sentence.hpp"
#include "grabbers/wire/scan_encoding.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;

constexpr std::size_t kParts = 256;  // of a capture
constexpr std::size_t kLasers = 3;
constexpr std::int64_t kSecond = 1'000'000'000;

Rig unknown_devices() {
  Rig rig = default_rig();
  for (auto& laser : rig.lasers) laser.address.ip.replace(laser.address.ip.rfind('.') + 1, 1, "20");
  for (std::size_t i = 0; i < rig.lasers.size(); ++i) rig.lasers[i].address.ip += std::to_string(i);
  rig.plate.address.ip = "192.168.0.210";
  return rig;
}

/// The telegram of a scan; nothing if no telegram can encode it.
std::optional<ScanData> telegram_of(const Scan& scan) {
  try {
    return to_scan_data(scan);
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool is_readable(const Scan& scan) {
  if (scan.echoes.empty() || scan.angle_step == 0) return false;
  return std::ranges::any_of(scan.echoes.front().ranges, [](float range) { return range > 0; });
}

/// Clips to the seconds that a pcap file can store.
std::int64_t in_era(std::int64_t ns) {
  constexpr std::int64_t kEra = (std::int64_t{1} << 32) * kSecond;
  return (ns % kEra + kEra) % kEra;
}

/// The last byte of the addresses of an IPv4 frame.
bool is_from_or_to(const Frame& frame, std::uint8_t host) {
  constexpr std::size_t kSource = 29, kDestination = 33;
  return frame.bytes.size() > kDestination &&
         (frame.bytes[kSource] == host || frame.bytes[kDestination] == host);
}

}  // namespace

/// The network of the hub: the rig's devices, and as many unknown ones.
class CaptureScript::Network {
 public:
  explicit Network(ColaLanguage language)
      : sorter_(
            [this](std::int64_t ns, ByteView bytes) {
              frames_.push_back({in_era(ns), Bytes(bytes.begin(), bytes.end())});
            },
            0),
        own_(default_rig(), language, sink()),
        other_(unknown_devices(), language, sink()) {}

  void connect(std::size_t laser, std::int64_t ns) {
    constexpr std::int64_t kHandshake = 5'000'000;
    own_.connect(laser, ns - kHandshake);
    connected_[laser] = true;
  }
  void send_scan(std::size_t laser, bool is_unknown, ByteView telegram, std::int64_t ns) {
    const std::size_t connection = laser + (is_unknown ? kLasers : 0);
    HubTrafficEncoder& hub = is_unknown ? other_ : own_;
    if (!connected_.at(connection)) hub.connect(laser, ns - kSecond / 100);
    connected_[connection] = true;
    hub.telegram(laser, telegram, ns);
    sorter_.finish();
  }
  void send_reading(bool is_unknown, const PlateReading& reading) {
    (is_unknown ? other_ : own_).reading(reading);
    sorter_.finish();
  }
  std::vector<Frame> frames() { return std::move(frames_); }

 private:
  FrameSink sink() {
    return [this](std::int64_t ns, ByteView bytes) { sorter_.push(ns, bytes); };
  }

  std::vector<Frame> frames_;
  FrameSorter sorter_;
  HubTrafficEncoder own_, other_;
  std::array<bool, 2 * kLasers> connected_{};
};

CaptureScript::CaptureScript(std::span<const std::uint8_t> script)
    : language_(!script.empty() && (script[0] & 1U) != 0 ? ColaLanguage::A : ColaLanguage::B) {
  if (script.empty()) return;
  constexpr std::size_t kEdit = 4;
  const std::size_t edits = script[0] >> 1U & 7U;
  script = script.subspan(1);
  for (std::size_t i = 0; i < edits && script.size() >= kEdit; ++i, script = script.subspan(kEdit)) {
    edits_.push_back({static_cast<Operation>(script[0] % kOperations), script[1],
                      std::min<std::size_t>(kParts, script[1] + script[2] + 1U), script[3]});
  }
  items_ = script;
}

bool CaptureScript::is_lossy() const {
  return std::ranges::any_of(edits_, [](const Edit& edit) {
    return edit.operation == Operation::unknown_address || edit.operation == Operation::same_address ||
           edit.operation == Operation::lose;
  });
}

bool CaptureScript::covers(const Edit& edit, std::size_t index, std::size_t all) const {
  return index >= all * edit.begin / kParts && index < all * edit.end / kParts;
}

Bytes CaptureScript::file() {
  const ItemSequence items = ItemScript(items_).items();
  Network network(language_);
  for (std::size_t i = 0; i < items.size(); ++i) send(items, i, network);
  std::vector<Frame> frames = network.frames();
  for (const Edit& edit : edits_) apply(edit, frames);
  return pcap_file(frames);
}

void CaptureScript::send(const ItemSequence& items, std::size_t index, Network& network) {
  const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&items[index]);
  const std::size_t device = scan == nullptr ? kPlateDevice : (*scan)->laser;
  if (device > kPlateDevice || (scan != nullptr && device == kPlateDevice)) return;
  bool is_unknown = false;
  std::size_t laser = device;
  for (const Edit& edit : edits_) {
    const bool begins = index == items.size() * edit.begin / kParts;
    if (edit.operation == Operation::reconnect && begins)
      network.connect(edit.argument % kLasers, receipt_ns(items[index]));
    if (!covers(edit, index, items.size())) continue;
    if (edit.operation == Operation::unknown_address && edit.argument % 4U == device) is_unknown = true;
    if (edit.operation == Operation::same_address && edit.argument % kLasers == device)
      laser = (device + 1) % kLasers;
  }
  if (scan == nullptr) {
    const auto& reading = std::get<PlateReading>(items[index]);
    return network.send_reading(is_unknown, reading);
  }
  const auto data = telegram_of(**scan);
  if (!data) return;
  network.send_scan(laser, is_unknown, encode_scan_data(*data, language_), (*scan)->receipt_ns);
  const bool is_new = counters_[device] != (*scan)->telegram_counter;
  counters_[device] = (*scan)->telegram_counter;
  if (is_new && is_readable(**scan)) ++scans_[device];
}

void CaptureScript::apply(const Edit& edit, std::vector<Frame>& frames) const {
  const auto all = static_cast<std::ptrdiff_t>(frames.size());
  const auto begin = frames.begin() + all * static_cast<std::ptrdiff_t>(edit.begin) / std::ptrdiff_t{kParts};
  const auto end = frames.begin() + all * static_cast<std::ptrdiff_t>(edit.end) / std::ptrdiff_t{kParts};
  switch (edit.operation) {
    case Operation::lose:
      frames.erase(begin, end);
      return;
    case Operation::repeat: {
      const std::vector<Frame> copies(begin, end);
      frames.insert(end, copies.begin(), copies.end());
      return;
    }
    case Operation::swap:
      std::rotate(begin, begin + (end - begin) / 2, end);
      return;
    case Operation::reverse_parts: {
      const std::ptrdiff_t part = std::max<std::ptrdiff_t>(1, (end - begin) / 10);
      std::reverse(begin, end);
      for (auto at = begin; at < end; at += std::min(part, end - at))
        std::reverse(at, at + std::min(part, end - at));
      return;
    }
    case Operation::shift:
    case Operation::shift_laser: {
      const bool is_of_one = edit.operation == Operation::shift_laser;
      const auto host = static_cast<std::uint8_t>(1 + edit.argument % kLasers);
      const std::int64_t by =
          is_of_one ? 37 * kSecond : static_cast<std::int64_t>(1e9 * jump_of(edit.argument));
      for (auto at = begin; at < end; ++at) {
        if (!is_of_one || is_from_or_to(*at, host)) at->time_ns = in_era(at->time_ns + by);
      }
      return;
    }
    default:
      return;
  }
}

}  // namespace crisp
