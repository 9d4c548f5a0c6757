// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace crisp::report {

/// RFC 4648, with padding, in one line.
std::string base64_of(std::span<const unsigned char> bytes);

}  // namespace crisp::report
