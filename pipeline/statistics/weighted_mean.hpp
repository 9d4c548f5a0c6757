// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace crisp::statistics {

/// Running weighted mean.
struct Mean {
  double weight = 0;
  double sum = 0;
  void add(double value, double w) {
    weight += w;
    sum += w * value;
  }
  double value() const { return weight > 0 ? sum / weight : 0; }
};

}  // namespace crisp::statistics
