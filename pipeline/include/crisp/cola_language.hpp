// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace crisp {

/// The two languages of SICK's devices: CoLa-A is ASCII between STX and ETX, CoLa-B is binary with a length
/// and a checksum.
enum class ColaLanguage : std::uint8_t { A, B };

}  // namespace crisp
