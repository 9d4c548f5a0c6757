// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <crisp/sensor_model.hpp>

namespace crisp::estimate {

/// The parameters of equation (2), in the order in which a laser's chain has them.
enum BaseSlot : std::size_t { kLambda, kTau, kAlpha, kEta };

/// Index into model.values().
inline std::size_t slot(const SensorModel& model, std::size_t laser, BaseSlot which) {
  return model.chain(laser).slots[which];
}

inline bool is_free(const std::vector<std::size_t>& free, std::size_t parameter) {
  return std::ranges::find(free, parameter) != free.end();
}

}  // namespace crisp::estimate
