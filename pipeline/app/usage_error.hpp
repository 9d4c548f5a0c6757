// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace crisp {

/// What people are told of a command line that cannot be understood: all that was not expected, in their
/// order, what it may have been meant to be, and whose help tells more. With a line break at the end.
std::string usage_error(const CLI::App& app, const CLI::Error& error);

}  // namespace crisp
