// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include <crisp/scan.hpp>

namespace crisp::data {

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

}  // namespace crisp::data
