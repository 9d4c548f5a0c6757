// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "grabbers/capture/hub_traffic_encoder.hpp"
#include "grabbers/capture/pcap_writer.hpp"
#include "grabbers/simulate/recording.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {

/// Faults of frames between the devices and the file.
struct WireFaults {
  double lost = 0;      ///< share that the capture does not hold
  double repeated = 0;  ///< share that is there twice, the second some milliseconds later
  double damaged = 0;   ///< share with one bit of the payload flipped
};

/// Applies faults to frames on their way to the next sink.
class FaultyWire {
 public:
  struct Counts {
    std::uint64_t lost = 0;
    std::uint64_t repeated = 0;
    std::uint64_t damaged = 0;
  };

  /// @throws Error if a share is not between 0 and 1
  FaultyWire(const WireFaults& faults, std::uint64_t seed, capture::FrameSink sink);

  void push(std::int64_t time_ns, wire::ByteView frame);
  const Counts& counts() const { return counts_; }

 private:
  WireFaults faults_;
  statistics::RandomStream random_;
  capture::FrameSink sink_;
  Counts counts_;
};

/// Writes what the hub received as the capture that tcpdump would have made there.
class RecordedCapture {
 public:
  /// @param path  takes the capture when it is complete; nothing is there before
  /// @throws Error if the file cannot be written, or the rig's addresses are none
  RecordedCapture(std::filesystem::path path, RecordingSettings settings, RecordingTruth truth,
                  const WireFaults& faults = {});

  /// Events must come in the order of receipt.
  void write(const HubEvent& event);

  /// Ends the connections and gives the file its name. @throws Error if the disk is full
  void close();

  const FaultyWire::Counts& faults() const { return wire_.counts(); }

 private:
  void write(const LaserTelegram& telegram);
  void write(const PlateReading& reading);

  RecordingSettings settings_;
  RecordingTruth truth_;
  capture::PcapWriter file_;
  capture::FrameSorter sorter_;
  FaultyWire wire_;
  capture::HubTrafficEncoder hub_;
  std::vector<std::size_t> restarts_;  ///< of each laser
  std::int64_t latest_ns_ = 0;
};

}  // namespace crisp::simulate
