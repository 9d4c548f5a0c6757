// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include <crisp/rig.hpp>

#include "pipeline/data/echoes.hpp"

namespace crisp::data {

/// The scan with the echoes that the rig chooses for its laser.
inline std::shared_ptr<const Scan> with_used_echoes(std::shared_ptr<const Scan> scan, const Rig& rig) {
  EchoCounts counts;
  if (!scan || scan->laser >= rig.lasers.size()) return scan;
  const EchoChoice choice = rig.lasers[scan->laser].echo;
  return with_used_echoes(std::move(scan), choice, counts);
}

}  // namespace crisp::data
