// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace crisp::report {

/// The files of plugins/report/page/, as they were when crisp was built.
extern const std::string_view kPageStyle;
/// In the order in which they stand in the page.
extern const std::span<const std::string_view> kPageScripts;

}  // namespace crisp::report
