// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace crisp::app {

/// Message for an invalid command line: all unexpected arguments in their order, the nearest valid one, and
/// the help to consult. Ends with a line break.
std::string usage_error(const CLI::App& app, const CLI::Error& error);

}  // namespace crisp::app
