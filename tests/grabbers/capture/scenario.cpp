// SPDX-License-Identifier: BSD-3-Clause
#include "tests/grabbers/capture/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "grabbers/wire/plate_sentence.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;

std::int64_t scan_time(std::size_t laser, std::size_t k) {
  return kStart +
         (20 * static_cast<std::int64_t>(k) + 5 + 3 * static_cast<std::int64_t>(laser)) * kNsPerMillisecond;
}

std::int64_t reading_time(std::size_t k) {
  return kStart + static_cast<std::int64_t>(k) * 2 * kNsPerMillisecond + 77'000;
}

ScanData scan_of(std::size_t laser, std::size_t k, std::size_t beams) {
  auto data = numbered_scan(static_cast<std::uint16_t>(k), beams);
  data.serial_number = static_cast<std::uint32_t>(1000 + laser);
  return data;
}

}  // namespace

std::vector<Frame> Scenario::frames() const {
  std::vector<Frame> all;
  FrameSorter sorter(into(all), 1'000'000'000);
  const FrameSink sink = [&](std::int64_t t, ByteView b) { sorter.push(t, b); };
  const Address other_port{kHub.ip, static_cast<std::uint16_t>(kHub.port + 1)};
  std::vector<TcpConversation> lasers{
      {kLaser1, kHub, sink, tcp},
      {same_address ? kLaser1 : kLaser2, same_address ? other_port : kHub, sink, tcp}};
  DatagramSender plate(kPlate, kHubPlate, sink);
  for (std::size_t laser = 0; handshake && laser < 2; ++laser) {
    lasers[laser].open(kStart - 500 * kNsPerMillisecond);
    lasers[laser].send(TcpSide::Client, cola_frame(as_bytes("sEN LMDscandata 1"), language),
                       kStart - 400 * kNsPerMillisecond);
    lasers[laser].send(TcpSide::Server, cola_frame(as_bytes("sEA LMDscandata 1"), language),
                       kStart - 399 * kNsPerMillisecond);
  }
  for (std::size_t k = 0; k < scans; ++k) {
    for (std::size_t laser = 0; laser < 2; ++laser) {
      ScanData scan = scan_of(laser, k, beams);
      if (same_address && laser == 1) scan.telegram_counter += 1000;
      if (laser == 1 && is_unreadable && is_unreadable(k)) {
        scan.channels16.push_back({.name = "DIST2", .start_angle = 0, .raw = {1}});
      }
      lasers[laser].send(TcpSide::Server, encode_scan_data(scan, language), scan_time(laser, k));
    }
    for (std::size_t j = 10 * k; j < 10 * k + 10; ++j) {
      plate.send(as_bytes(encode_plate_sentence(numbered_reading(static_cast<std::uint16_t>(j)))),
                 reading_time(j));
    }
  }
  sorter.finish();
  return all;
}

std::vector<HubItem> Scenario::items() const {
  std::vector<HubItem> all;
  for (std::size_t k = 0; k < scans; ++k) {
    for (std::size_t laser = 0; laser < 2; ++laser) {
      const auto data = scan_of(laser, k, beams);
      Scan scan{.laser = static_cast<std::uint16_t>(laser), .serial_number = data.serial_number};
      scan.telegram_counter = data.telegram_counter;
      scan.scan_counter = data.scan_counter;
      scan.scan_time_us = data.scan_time_us;
      scan.transmission_time_us = data.transmission_time_us;
      scan.receipt_ns = scan_time(laser, k);
      scan.scan_frequency = 50;
      scan.echoes.resize(1);
      for (const auto raw : data.channels16[0].raw)
        scan.echoes[0].ranges.push_back(static_cast<float>(raw * 1e-3));
      all.emplace_back(std::make_shared<const Scan>(std::move(scan)));
    }
    for (std::size_t j = 10 * k; j < 10 * k + 10; ++j) {
      auto reading = numbered_reading(static_cast<std::uint16_t>(j));
      reading.receipt_ns = reading_time(j);
      all.emplace_back(reading);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return receipt_ns(a) < receipt_ns(b); });
  return all;
}

std::string describe(const HubItem& item) {
  if (const auto* reading = std::get_if<PlateReading>(&item)) {
    return fmt::format("{} plate {} {} {}", reading->receipt_ns - kStart, reading->sequence,
                       reading->device_us, reading->count);
  }
  const auto& scan = *std::get<std::shared_ptr<const Scan>>(item);
  double weighted = 0;
  std::size_t beams = 0;
  for (const auto& echo : scan.echoes) {
    for (const auto range : echo.ranges) weighted += static_cast<double>(++beams) * range;
  }
  return fmt::format("{} laser {} serial {} counters {} {} times {} {} beams {} weighted {:.3f}",
                     scan.receipt_ns - kStart, scan.laser, scan.serial_number, scan.telegram_counter,
                     scan.scan_counter, scan.scan_time_us, scan.transmission_time_us, beams, weighted);
}

std::vector<std::string> describe(const std::vector<HubItem>& items) {
  std::vector<std::string> lines;
  for (const auto& item : items) lines.push_back(describe(item));
  return lines;
}

const DeviceStatistics& Reading::device(const std::string& name) const {
  for (const auto& device : statistics.devices) {
    if (device.name == name) return device;
  }
  throw std::runtime_error("no device " + name);
}

Reading read_capture(const std::filesystem::path& file, const Rig& rig, const CaptureSettings& settings) {
  Reading reading;
  CaptureReader reader(file, rig, settings);
  while (const auto item = reader.next()) reading.items.push_back(describe(*item));
  reading.statistics = reader.statistics();
  return reading;
}

Reading read_capture(ByteView file, const CaptureSettings& settings) {
  return read_capture(MemoryFile(file).path(), default_rig(), settings);
}

}  // namespace crisp
