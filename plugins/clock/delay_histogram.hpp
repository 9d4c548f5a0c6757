// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace crisp::clock {

/// Counts delays in bins of equal ratio, so that quantiles of any number of them need no memory.
class DelayHistogram {
 public:
  void add(double delay);
  /// @param share 0 to 1
  /// @return [s] to within 1 %, of delays between 10 ns and 1000 s; 0 if there are none
  double quantile(double share) const;

 private:
  static constexpr std::size_t kBins = 2532;  // 11 decades in steps of 1 %
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
};

}  // namespace crisp::clock
