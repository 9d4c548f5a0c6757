// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <optional>

#include <crisp/error.hpp>

namespace crisp::data {

/// Error for an exception of the standard library about exhausted memory or threads; nothing for
/// any other exception.
std::optional<Error> resource_exhaustion(const std::exception& thrown);

/// Any exception as an Error: an Error itself, lack of resources, a refusal of the system, or a fault of
/// the program.
Error error_of(const std::exception& thrown);

}  // namespace crisp::data
