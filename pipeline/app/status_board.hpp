// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/stage/context.hpp"

namespace crisp {

/// What the stages of a run last told of themselves. May be used from several threads.
class StatusBoard {
 public:
  void tell(const std::string& tag, const StageStatus& status);

  /// All in one line, in the order in which the stages first told something.
  std::string line() const;
  /// The gauges in Prometheus' text format 0.0.4, as crisp_NAME{stage="TAG",device="DEVICE"}.
  std::string prometheus() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<std::string, StageStatus>> stages_;
};

}  // namespace crisp
