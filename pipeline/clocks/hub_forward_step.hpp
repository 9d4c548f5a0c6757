// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "pipeline/clocks/unwrap.hpp"

namespace crisp::clocks {

/// Distinguishes a forward step of the hub's clock from a pause in which nothing was recorded. After a step,
/// all devices' clocks have run on by less than the hub's, and by the same amount less.
class ForwardStep {
 public:
  /// Notes a telegram that came before the gap in the receipts.
  void before(std::size_t device, const DeviceStamp& stamp) { before_[device] = stamp; }
  /// Notes a telegram that came after it.
  void after(std::size_t device, const DeviceStamp& stamp);

  /// [ns] By how much the hub's clock was set forward. Nothing where fewer than two devices show it, where
  /// one contradicts, or where their clocks do not run evenly after the gap, as after a backlog of telegrams.
  std::optional<std::int64_t> size_ns() const;

  /// Forgets what came after the gap; what came before it is replaced by what comes next.
  void forget_after() { after_.clear(); }

 private:
  struct After {
    DeviceStamp first, last;
  };
  std::map<std::size_t, DeviceStamp> before_;
  std::map<std::size_t, After> after_;
};

}  // namespace crisp::clocks
