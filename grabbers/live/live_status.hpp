// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grabbers/capture/capture_statistics.hpp"
#include "pipeline/stage/context.hpp"

namespace crisp {

/// How a live source is doing: what came since it was asked last, and what was lost since the beginning.
class LiveStatus {
 public:
  /// An item came through all stages that it drove.
  /// @param latency  [s] since it was received
  void passed(double latency) { latencies_.push_back(latency); }

  /// Its events are the losses and notes that became more, each kind of them at most every ten seconds.
  /// @param now      [s] of any steady clock
  /// @param waiting  items that the pipeline has not taken yet
  /// @param running  what a person is told of the time: "12 s of 60 s"
  StageStatus tell(const CaptureStatistics& statistics, double now, std::size_t waiting,
                   const std::string& running);

 private:
  /// Adds what of these became more.
  void note(const std::string& device, const Counts& counts, double now, std::vector<std::string>& events);

  struct Event {
    std::uint64_t told = 0;  ///< how often it had happened
    double again = 0;        ///< [s] when it may be told again
  };
  std::vector<double> latencies_;
  std::map<std::string, Event> events_;
  std::map<std::string, std::uint64_t> items_;  ///< of each device when it was asked last
  std::optional<double> asked_;
};

/// All that was lost of a device's items, or on the way to them.
std::uint64_t lost_items(const CaptureStatistics& statistics);

}  // namespace crisp
