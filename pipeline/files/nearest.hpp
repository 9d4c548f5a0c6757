// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crisp::files {

/// The known name that `name` was probably meant to be: the one of least edit distance, if that is at most a
/// third of the name's length, rounded up. The first of equals.
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known);

/// "did you mean 'sigma'?" where a known name is near; otherwise `otherwise`.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known, std::string otherwise);

}  // namespace crisp::files
