// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "pipeline/data/scan.hpp"

namespace crisp {

/// Which echoes of a beam are used, where a laser sends several.
enum class EchoChoice : std::uint8_t {
  first,      ///< the first that came back
  last,       ///< the last that came back
  strongest,  ///< the one of the largest remission; without remissions the first
  all         ///< each as a beam of the same instant
};

/// Counts of a choice of echoes.
struct EchoCounts {
  std::uint64_t later = 0;   ///< beams whose first echo is empty, and a later one is used
  std::uint64_t unused = 0;  ///< echoes that came back and are not used
};

/// The scan with the used echoes of each beam alone: one echo a beam, or of EchoChoice::all as many as came
/// back, without empty ones before others. A scan of one echo stays as it is.
/// @param counts  is added to
std::shared_ptr<const Scan> with_used_echoes(std::shared_ptr<const Scan> scan, EchoChoice choice,
                                             EchoCounts& counts);

}  // namespace crisp
