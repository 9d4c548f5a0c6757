// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/term.hpp>

namespace crisp::app {

/// Full description of an effect, for a terminal.
std::string effect_text(const EffectInfo& effect);

/// The catalogue as a page, in Markdown.
std::string effects_markdown(const std::vector<EffectInfo>& catalogue);

}  // namespace crisp::app
