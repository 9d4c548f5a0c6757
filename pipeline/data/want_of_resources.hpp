// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <optional>

#include "pipeline/data/error.hpp"

namespace crisp {

/// Error for an exception of the standard library about exhausted memory or threads; nothing for
/// any other exception.
std::optional<Error> want_of_resources(const std::exception& thrown);

}  // namespace crisp
