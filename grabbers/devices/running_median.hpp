// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::devices {

/// The median of any number of values in constant memory: exact up to 4096 values, from then on of every
/// second, fourth … of them.
class RunningMedian {
 public:
  void add(double value) {
    if (count_++ % stride_ != 0) return;
    if (values_.size() == kMax) {
      for (std::size_t i = 0; 2 * i < kMax; ++i) values_[i] = values_[2 * i];
      values_.resize(kMax / 2);
      stride_ *= 2;
      if ((count_ - 1) % stride_ != 0) return;
    }
    values_.push_back(value);
  }

  std::optional<double> value() const {
    if (values_.empty()) return {};
    auto sorted = values_;
    return statistics::median_in_place(sorted);
  }

 private:
  static constexpr std::size_t kMax = 4096;

  std::vector<double> values_;
  std::size_t count_ = 0, stride_ = 1;
};

}  // namespace crisp::devices
