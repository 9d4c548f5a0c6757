// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <crisp/measure.hpp>

namespace crisp::test {

/// RQE as the studies' tests want it: fast.
inline std::unique_ptr<Measure> make_rqe() {
  static const auto kSearches = [] {
    SearchRegistry registry;
    register_built_in(registry);
    return registry;
  }();
  static const auto kMeasures = [] {
    MeasureRegistry registry;
    register_built_in(registry);
    return registry;
  }();
  return kMeasures.make("rqe", {.search = "grid", .cutoff = 5}, kSearches);
}

}  // namespace crisp::test
