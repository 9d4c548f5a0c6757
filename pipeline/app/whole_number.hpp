// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace crisp::app {

/// Refuses what is no whole number from `least` to `most`.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);

}  // namespace crisp::app
