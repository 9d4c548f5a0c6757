// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <optional>

#include "pipeline/data/error.hpp"

namespace crisp {

/// What an exception of the standard library means where the system refused memory or a thread; nothing of
/// any other exception.
std::optional<Error> want_of_resources(const std::exception& thrown);

}  // namespace crisp
