// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <crisp/capture_statistics.hpp>
#include <crisp/context.hpp>

namespace crisp::live {

/// Status of a live source: what was received since the last report, and all losses.
class LiveStatus {
 public:
  /// An item came through all stages that it drove.
  /// @param latency  [s] since it was received
  void passed(double latency) { latencies_.push_back(latency); }

  /// Its events are increased losses and notes, each kind at most every ten seconds.
  /// @param now      [s] of any steady clock
  /// @param waiting  items that the pipeline has not taken yet
  /// @param running  elapsed time for people: "12 s of 60 s"
  StageStatus report(const CaptureStatistics& statistics, double now, std::size_t waiting,
                     const std::string& running);

 private:
  /// Adds what of these became more.
  void note(const std::string& device, const Counts& counts, double now, std::vector<std::string>& events);

  struct Event {
    std::uint64_t reported = 0;  ///< how often it had happened
    double again = 0;            ///< [s] earliest time of its next report
  };
  std::vector<double> latencies_;
  std::map<std::string, Event> events_;
  std::map<std::string, std::uint64_t> items_;  ///< of each device at the last report
  std::optional<double> requested_;
};

/// Number of a device's lost items, by all causes.
std::uint64_t lost_items(const CaptureStatistics& statistics);

}  // namespace crisp::live
