// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <crisp/context.hpp>

namespace crisp::app {

/// The latest status of each stage of a run. Thread-safe.
class StatusBoard {
 public:
  /// @param tags  of the stages, in the pipeline's order
  explicit StatusBoard(std::vector<std::string> tags) : tags_(std::move(tags)) {}

  void set_status(const std::string& tag, const StageStatus& status);

  /// All in one line, in the pipeline's order.
  std::string line() const;
  /// The gauges in Prometheus' text format 0.0.4, as crisp_NAME{stage="TAG",device="DEVICE"}.
  std::string prometheus() const;

 private:
  const std::vector<std::string> tags_;
  mutable std::mutex mutex_;
  std::map<std::string, StageStatus> reported_;  ///< by tag
};

}  // namespace crisp::app
