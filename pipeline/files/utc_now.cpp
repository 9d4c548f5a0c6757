// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/utc_now.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

namespace crisp::files {

std::string utc_now() { return fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))); }

}  // namespace crisp::files
