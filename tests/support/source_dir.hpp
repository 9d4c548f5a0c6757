// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace crisp {

/// The folder of the sources. It is compiled into one file alone, so that what a compiler cache holds of all
/// others serves any checkout.
std::string source_dir();

}  // namespace crisp
