// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/recorded_capture.hpp"

#include <fmt/format.h>

#include <crisp/error.hpp>

#include "grabbers/wire/scan_data.hpp"

namespace crisp::simulate {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kHold = 100 * kMillisecond;  // longer than any frame lies before or behind its event
constexpr std::size_t kHeaders = 54;  // Ethernet, IPv4 and TCP: damage behind them hits the payload

}  // namespace

FaultyWire::FaultyWire(const WireFaults& faults, std::uint64_t seed, capture::FrameSink sink)
    : faults_(faults), random_(seed, "wire"), sink_(std::move(sink)) {
  for (const double share : {faults.lost, faults.repeated, faults.damaged}) {
    if (!(share >= 0 && share <= 1)) {
      throw Error(fmt::format("the share of faulty frames is {:g}", share),
                  "give lost_frames, repeated_frames and damaged_frames from 0 to 1");
    }
  }
}

void FaultyWire::push(std::int64_t time_ns, wire::ByteView frame) {
  const bool lost = random_.chance(faults_.lost);
  const bool repeated = random_.chance(faults_.repeated);
  const bool damaged = random_.chance(faults_.damaged) && frame.size() > kHeaders;
  if (lost) {
    ++counts_.lost;
    return;
  }
  if (repeated) {
    ++counts_.repeated;
    const auto later =
        static_cast<std::int64_t>(random_.uniform(2.4, 2.9) * static_cast<double>(kMillisecond));
    sink_(time_ns + later, frame);
  }
  if (!damaged) return sink_(time_ns, frame);
  ++counts_.damaged;
  wire::Bytes bytes(frame.begin(), frame.end());
  const auto bit = random_.bits() % ((bytes.size() - kHeaders) * 8);
  bytes[kHeaders + bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
  sink_(time_ns, bytes);
}

RecordedCapture::RecordedCapture(std::filesystem::path path, RecordingSettings settings, RecordingTruth truth,
                                 const WireFaults& faults)
    : settings_(std::move(settings)),
      truth_(std::move(truth)),
      file_(std::move(path), capture::PcapMode::Replace),
      sorter_(
          [this](std::int64_t ns, wire::ByteView frame) {
            wire::Bytes simulated(frame.begin(), frame.end());
            capture::mark_as_simulated(simulated);
            file_.write(ns, simulated);
          },
          kHold),
      wire_(faults, settings_.scanner.seed,
            [this](std::int64_t ns, wire::ByteView frame) { sorter_.push(ns, frame); }),
      hub_(settings_.scanner.rig, settings_.telegrams.language,
           [this](std::int64_t ns, wire::ByteView frame) { wire_.push(ns, frame); }),
      restarts_(settings_.scanner.rig.lasers.size()) {
  constexpr std::int64_t kBefore = 200 * kMillisecond;  // the encoder readings begin 100 ms before time 0
  for (std::size_t i = 0; i < restarts_.size(); ++i) {
    hub_.connect(i, settings_.start_ns - kBefore + static_cast<std::int64_t>(i) * kMillisecond);
  }
}

void RecordedCapture::write(const HubEvent& event) {
  latest_ns_ = receipt_ns(event);
  std::visit([this](const auto& received) { write(received); }, event);
}

void RecordedCapture::write(const LaserTelegram& telegram) {
  const double received = 1e-9 * static_cast<double>(telegram.receipt_ns - settings_.start_ns);
  const auto& device = truth_.lasers[telegram.laser];
  const auto restarts = device.clock.resets_before(received - device.minimum_delay);
  if (restarts != restarts_[telegram.laser]) {
    restarts_[telegram.laser] = restarts;
    hub_.connect(telegram.laser, telegram.receipt_ns - 5 * kMillisecond);
  }
  hub_.telegram(telegram.laser, wire::encode_scan_data(telegram.data, settings_.telegrams.language),
                telegram.receipt_ns);
}

void RecordedCapture::write(const PlateReading& reading) { hub_.reading(reading); }

void RecordedCapture::close() {
  hub_.close(latest_ns_ + 10 * kMillisecond);
  sorter_.finish();
  file_.close();
}

}  // namespace crisp::simulate
