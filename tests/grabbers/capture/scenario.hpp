// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <crisp/capture_reader.hpp>

#include "tests/grabbers/capture/capture_bytes.hpp"

namespace crisp {

/// A captured run of the default rig without its third laser: n scans of each of two lasers, 50 a second, and
/// ten times as many encoder readings.
struct Scenario {
  std::size_t scans = 10;
  std::size_t beams = 20;
  ColaLanguage language = ColaLanguage::B;
  capture::TcpSettings tcp;
  bool handshake = true;
  bool same_address = false;                         ///< the second laser has the first one's
  std::function<bool(std::size_t k)> is_unreadable;  ///< scan k of the second laser, by its channels

  std::vector<Frame> frames() const;   ///< what tcpdump would have captured
  std::vector<HubItem> items() const;  ///< what a reader is to find, in order
};

/// The item in one line: which, when, and its content.
std::string describe(const HubItem& item);
std::vector<std::string> describe(const std::vector<HubItem>& items);

/// What a reader of the default rig gives for this file.
struct Reading {
  std::vector<std::string> items;
  CaptureStatistics statistics;
  const DeviceStatistics& device(const std::string& name) const;
};
Reading read_capture(wire::ByteView file, const CaptureSettings& settings = {});
Reading read_capture(const std::filesystem::path& file, const Rig& rig = default_rig(),
                     const CaptureSettings& settings = {});

}  // namespace crisp
