// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace crisp::files {

/// The time of day in UTC as in ISO 8601: "2026-03-01T09:14:07Z".
std::string utc_now();

}  // namespace crisp::files
