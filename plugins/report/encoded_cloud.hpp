// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "plugins/report/shown_cloud.hpp"

namespace crisp::report {

/// A cloud as a page holds it: quantised columns, deflated (RFC 1950), in base64.
///
/// The bytes of one column follow those of the one before: of each of its n whole numbers the lowest byte,
/// then of each the next, and so on. Where `delta` holds, each number is the difference from the one before,
/// modulo 256 to the power of the bytes. value = offset + step · number; the greatest number stands for none
/// where `gaps` holds.
struct EncodedCloud {
  nlohmann::ordered_json
      header;  ///< points, error [m], and for each column name, bytes, delta, gaps, offset, step
  std::string base64;
};

/// [m] Between neighbouring values of a coordinate: it is off by half of that at most.
inline constexpr double kCoordinateStep = 1e-3;

EncodedCloud encode(const ShownCloud& cloud);

}  // namespace crisp::report
