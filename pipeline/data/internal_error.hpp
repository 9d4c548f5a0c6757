// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/error.hpp>

namespace crisp::data {

/// A fault of the program, which no input and no setting explains. Its one advice is to report it.
Error internal_error(const std::string& what);

}  // namespace crisp::data
